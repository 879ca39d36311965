// SPDX-License-Identifier: MIT
// Vertices of a head on its bones (linear blend skinning): a thread a vertex.
#include "live_types.h"

cbuffer Constants : register(b0) { HeadConstants gHead; };
StructuredBuffer<float4> gBones : register(t0);  // three rows a bone, from the head at rest to the world
StructuredBuffer<float> gRest : register(t1);    // three a vertex
StructuredBuffer<float> gRestNormals : register(t2);
StructuredBuffer<uint4> gBoneOf : register(t3);  // two a vertex; read where it is skinned
StructuredBuffer<float4> gWeights : register(t4);
RWStructuredBuffer<float> gPositions : register(u0);
RWStructuredBuffer<float> gNormals : register(u1);

float4 row(uint r, uint4 bones, float4 weights) {
    return gBones[3 * bones.x + r] * weights.x + gBones[3 * bones.y + r] * weights.y +
           gBones[3 * bones.z + r] * weights.z + gBones[3 * bones.w + r] * weights.w;
}

[numthreads(HAIRLOOM_LIVE_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const uint v = thread.x;
    if (v >= gHead.count) return;
    float4 x = gBones[0], y = gBones[1], z = gBones[2];
    if (gHead.skinned != 0u) {
        x = y = z = 0;
        [unroll] for (uint part = 0; part < 2u; ++part) {
            const float4 weights = gWeights[2 * v + part];
            const uint4 bones = gBoneOf[2 * v + part];
            // Few vertices have more than four; those beyond are 0.
            if (part == 1u && weights.x == 0.0) break;
            x += row(0, bones, weights);
            y += row(1, bones, weights);
            z += row(2, bones, weights);
        }
    }
    const float4 rest = float4(gRest[3 * v], gRest[3 * v + 1], gRest[3 * v + 2], 1);
    gPositions[3 * v] = dot(x, rest);
    gPositions[3 * v + 1] = dot(y, rest);
    gPositions[3 * v + 2] = dot(z, rest);
    // The cofactors keep a normal across under any scale.
    const float3 normal = float3(gRestNormals[3 * v], gRestNormals[3 * v + 1], gRestNormals[3 * v + 2]);
    const float3 turned = float3(dot(cross(y.xyz, z.xyz), normal), dot(cross(z.xyz, x.xyz), normal),
                                 dot(cross(x.xyz, y.xyz), normal));
    const float squared = dot(turned, turned);
    const float3 unit = squared > 1e-20 ? turned * (1.0 / sqrt(squared)) : normal;
    gNormals[3 * v] = unit.x;
    gNormals[3 * v + 1] = unit.y;
    gNormals[3 * v + 2] = unit.z;
}
