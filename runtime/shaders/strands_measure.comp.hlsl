// SPDX-License-Identifier: MIT
// What a person watches of moving strands, reduced: a thread a point. Words of gMeasures: greatest stretch of a segment as
// a share of its length, deepest penetration in m and greatest speed in m/s as bits of a float that is not negative; points
// that are no numbers; kinetic energy in two words of 1e-6 J, the low one first.
#include "live_types.h"

cbuffer Constants : register(b0) { MeasureConstants gMeasure; };
StructuredBuffer<float4> gPositions : register(t0);
StructuredBuffer<float4> gVelocities : register(t1);
StructuredBuffer<MeasuredPoint> gRest : register(t2);
StructuredBuffer<float4> gSpheres : register(t3);  // centre, radius
RWStructuredBuffer<uint> gMeasures : register(u0);

groupshared uint gStretch;
groupshared uint gDepth;
groupshared uint gSpeed;
groupshared uint gBad;
groupshared uint gEnergy;

/// At most what 64 points of a group add up to a word of.
uint microjoules(float joules) { return uint(min(joules * 1e6, 6e7)); }

[numthreads(HAIRLOOM_LIVE_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID, uint3 inGroup : SV_GroupThreadID, uint3 group : SV_GroupID) {
    if (inGroup.x == 0) {
        gStretch = gDepth = gSpeed = 0u;
        gBad = gEnergy = 0u;
    }
    GroupMemoryBarrierWithGroupSync();
    const uint i = group.y * (65535u * HAIRLOOM_LIVE_GROUP) + thread.x;
    if (i < gMeasure.points) {
        const float3 here = gPositions[i].xyz, velocity = gVelocities[i].xyz;
        const MeasuredPoint rest = gRest[i];
        const float speed = sqrt(dot(velocity, velocity));
        if (!(dot(here, here) < 1e12) || !(speed < 1e12)) {
            InterlockedAdd(gBad, 1u);
        } else {
            if (rest.segment > 1e-9) {
                const float3 chord = here - gPositions[i - 1].xyz;
                const float stretch = abs(sqrt(dot(chord, chord)) / rest.segment - 1.0);
                if (stretch < 1e12) InterlockedMax(gStretch, asuint(stretch));
            }
            if (rest.mass > 0.0) {
                InterlockedMax(gSpeed, asuint(speed));
                InterlockedAdd(gEnergy, microjoules(0.5 * rest.mass * speed * speed));
                const float own = lerp(gMeasure.collisionRadiusAtRoot, gMeasure.collisionRadiusAtTip, rest.along);
                float deepest = 0.0;
                [loop] for (uint s = 0; s < gMeasure.spheres; ++s) {
                    const float3 from = here - gSpheres[s].xyz;
                    deepest = max(deepest, gSpheres[s].w + own - sqrt(dot(from, from)));
                }
                InterlockedMax(gDepth, asuint(deepest));
            }
        }
    }
    GroupMemoryBarrierWithGroupSync();
    if (inGroup.x != 0) return;
    InterlockedMax(gMeasures[0], gStretch);
    InterlockedMax(gMeasures[1], gDepth);
    InterlockedMax(gMeasures[2], gSpeed);
    if (gBad > 0u) InterlockedAdd(gMeasures[3], gBad);
    uint before;
    InterlockedAdd(gMeasures[4], gEnergy, before);
    if (before + gEnergy < before) InterlockedAdd(gMeasures[5], 1u);
}
