// SPDX-License-Identifier: MIT
// Roots of strands on a head that has moved: a thread a root. A root turns with its triangle, about its own position.
#include "live_types.h"

cbuffer Constants : register(b0) { HeadConstants gHead; };
StructuredBuffer<float4> gBones : register(t0);
StructuredBuffer<HeadRoot> gRoots : register(t1);
StructuredBuffer<float> gRest : register(t2);       // three a vertex
StructuredBuffer<float> gPositions : register(t3);  // likewise, of now
RWStructuredBuffer<float4> gFrames : register(u0);  // two a root: position, w 1; rotation since rest

float3 restOf(uint v) { return float3(gRest[3 * v], gRest[3 * v + 1], gRest[3 * v + 2]); }
float3 positionOf(uint v) { return float3(gPositions[3 * v], gPositions[3 * v + 1], gPositions[3 * v + 2]); }

/// Rows: along the first edge, the normal, across. False where the triangle is flat.
bool frameOf(float3 a, float3 b, float3 c, out float3 along, out float3 normal, out float3 across) {
    along = b - a;
    normal = cross(along, c - a);
    across = float3(0, 0, 0);
    const float long_ = dot(along, along), wide = dot(normal, normal);
    if (!(long_ > 0.0) || !(wide > 0.0)) return false;
    along *= 1.0 / sqrt(long_);
    normal *= 1.0 / sqrt(wide);
    across = cross(along, normal);
    return true;
}

/// Of a rotation by its columns (Shepperd 1978): the greatest component first.
float4 quaternionOf(float3 x, float3 y, float3 z) {
    const float trace = x.x + y.y + z.z;
    float4 q = float4(y.z - z.y, z.x - x.z, x.y - y.x, 1.0 + trace);
    if (trace <= 0.0) {
        if (x.x >= y.y && x.x >= z.z) {
            q = float4(1.0 + x.x - y.y - z.z, y.x + x.y, z.x + x.z, y.z - z.y);
        } else if (y.y >= z.z) {
            q = float4(y.x + x.y, 1.0 + y.y - x.x - z.z, z.y + y.z, z.x - x.z);
        } else {
            q = float4(z.x + x.z, z.y + y.z, 1.0 + z.z - x.x - y.y, x.y - y.x);
        }
    }
    return q * (1.0 / sqrt(dot(q, q)));
}

[numthreads(HAIRLOOM_LIVE_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    if (thread.x >= gHead.count) return;
    const HeadRoot root = gRoots[thread.x];
    if (gHead.bound == 0u) {
        const float4 rest = float4(root.rest.xyz, 1);
        gFrames[2 * thread.x] = float4(dot(gBones[0], rest), dot(gBones[1], rest), dot(gBones[2], rest), 1);
        gFrames[2 * thread.x + 1] = gHead.turn;
        return;
    }
    const float3 a = restOf(root.corners.x), b = restOf(root.corners.y), c = restOf(root.corners.z);
    const float3 p = positionOf(root.corners.x), q = positionOf(root.corners.y), r = positionOf(root.corners.z);
    float3 x = float3(1, 0, 0), y = float3(0, 1, 0), z = float3(0, 0, 1);
    float3 along, normal, across, alongNow, normalNow, acrossNow;
    const bool isFrame = frameOf(a, b, c, along, normal, across);
    if (frameOf(p, q, r, alongNow, normalNow, acrossNow) && isFrame) {
        x = alongNow * along.x + normalNow * normal.x + acrossNow * across.x;
        y = alongNow * along.y + normalNow * normal.y + acrossNow * across.y;
        z = alongNow * along.z + normalNow * normal.z + acrossNow * across.z;
    }
    const float3 weights = root.barycentric.xyz;
    const float3 away = root.rest.xyz - (a * weights.x + b * weights.y + c * weights.z);
    const float3 here = p * weights.x + q * weights.y + r * weights.z;
    gFrames[2 * thread.x] = float4(here + x * away.x + y * away.y + z * away.z, 1);
    gFrames[2 * thread.x + 1] = quaternionOf(x, y, z);
}
