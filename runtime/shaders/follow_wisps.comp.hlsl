// SPDX-License-Identifier: MIT
// The wisp around each guide (Rünz 2012, Section 4.2): a thread walks its guide from root to tip.
#include "follow.hlsli"

StructuredBuffer<float4> gPositions : register(t0);      // of guides, m
StructuredBuffer<float4> gVelocities : register(t1);  // likewise, m/s
StructuredBuffer<FollowPlane> gPlanes : register(t2);
StructuredBuffer<float2> gSamples : register(t3);     // of each guide and point of a hair: point, share of the next
StructuredBuffer<float> gRadii : register(t4);        // per point, m
StructuredBuffer<float4> gFrames : register(t5);      // of guides: position; rotation since rest
RWStructuredBuffer<float4> gRows : register(u0);

/// Both ends exactly, and a share of 0 or 1 leaves out the point that it takes nothing of.
float3 positionAt(uint sample) {
    const uint p = asuint(gSamples[sample].x);
    const float share = gSamples[sample].y;
    if (share == 0.0) return gPositions[p].xyz;
    if (share == 1.0) return gPositions[p + 1].xyz;
    return gPositions[p].xyz + (gPositions[p + 1].xyz - gPositions[p].xyz) * share;
}
float3 velocityAt(uint sample) {
    if (gFollow.hasVelocities == 0u) return float3(0, 0, 0);
    const uint p = asuint(gSamples[sample].x);
    const float share = gSamples[sample].y;
    if (share == 0.0) return gVelocities[p].xyz;
    if (share == 1.0) return gVelocities[p + 1].xyz;
    return gVelocities[p].xyz + (gVelocities[p + 1].xyz - gVelocities[p].xyz) * share;
}

/// Turns a cross-section's frame the shortest way onto the direction of `chord`: for a normal across the tangent
/// the reflection in the plane half-way between the directions. A chord without length leaves it as it is.
void carry(float3 chord, inout float3 tangent, inout float3 normal) {
    const float squared = dot(chord, chord);
    if (!(squared > 1e-24 && squared < 1e30)) return;
    const float3 next = chord * (1.0 / sqrt(squared));
    const float3 halfway = tangent + next;
    const float size = dot(halfway, halfway);
    const float share = size > 1e-8 ? dot(halfway, normal) / size : 0.0;
    const float3 mirrored = normal - halfway * (share + share);
    const float3 across = mirrored - next * dot(mirrored, next);
    tangent = next;
    normal = across * (1.0 / sqrt(dot(across, across)));
}

[numthreads(32, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const uint guide = thread.x;
    if (guide >= gFollow.guides) return;
    const FollowPlane plane = gPlanes[guide];
    const float4 turn = gFrames[2 * guide + 1];
    const uint first = guide * gFollow.points, last = gFollow.points - 1;
    float3 normal = rotate(turn, plane.x.xyz);
    float3 tangent = rotate(turn, plane.normal.xyz);
    float3 before = positionAt(first), here = before;
    [loop] for (uint p = 0; p <= last; ++p) {
        // A point's tangent joins its neighbours.
        const float3 after = p < last ? positionAt(first + p + 1) : here;
        carry(after - before, tangent, normal);
        const float3 x = p == 0 ? rotate(turn, plane.x.xyz) : normal;
        const float3 y = p == 0 ? rotate(turn, plane.y.xyz) : cross(tangent, normal);
        const float3 velocity = velocityAt(first + p);
        const float speed = sqrt(dot(velocity, velocity)), radius = gRadii[p];
        const float sigma =
            min(gFollow.wispSpread * float(p) / float(last), (gFollow.wispLimit - 1.0) / max(speed, 1e-30));
        const float xi = 1.0 + sigma * speed;  // Eq. 22
        gRows[rowOf(guide, 0, p)] = float4(here, 0);
        // Eq. 23, where (ξ − 1) v/|v| = σ v is smooth at rest.
        gRows[rowOf(guide, 1, p)] = float4(here - velocity * (radius * sigma), 0);
        gRows[rowOf(guide, 2, p)] = float4(x * (radius * xi), 0);
        gRows[rowOf(guide, 3, p)] = float4(y * (radius * xi), 0);
        before = here;
        here = after;
    }
}
