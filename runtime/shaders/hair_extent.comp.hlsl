// SPDX-License-Identifier: MIT
// The box that hair is in, and some of its points: threads walk the points in strides.
#include "live_types.h"

cbuffer Constants : register(b0) { ExtentConstants gExtent; };
StructuredBuffer<float4> gPoints : register(t0);
RWStructuredBuffer<uint> gBox : register(u0);  // least, greatest
RWStructuredBuffer<float4> gSamples : register(u1);

groupshared uint gLeast[3];
groupshared uint gGreatest[3];

[numthreads(HAIRLOOM_LIVE_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID, uint3 inGroup : SV_GroupThreadID) {
    if (inGroup.x < 3) {
        gLeast[inGroup.x] = 0xffffffffu;
        gGreatest[inGroup.x] = 0u;
    }
    GroupMemoryBarrierWithGroupSync();
    float3 least = float3(1e30, 1e30, 1e30), greatest = -least;
    [loop] for (uint i = thread.x; i < gExtent.points; i += gExtent.threads) {
        const float3 p = gPoints[i].xyz;
        // What is no number is in no box.
        if (!(dot(p, p) < 1e12)) continue;
        least = min(least, p);
        greatest = max(greatest, p);
    }
    InterlockedMin(gLeast[0], orderedFloat(least.x));
    InterlockedMin(gLeast[1], orderedFloat(least.y));
    InterlockedMin(gLeast[2], orderedFloat(least.z));
    InterlockedMax(gGreatest[0], orderedFloat(greatest.x));
    InterlockedMax(gGreatest[1], orderedFloat(greatest.y));
    InterlockedMax(gGreatest[2], orderedFloat(greatest.z));
    GroupMemoryBarrierWithGroupSync();
    if (inGroup.x < 3) {
        InterlockedMin(gBox[inGroup.x], gLeast[inGroup.x]);
        InterlockedMax(gBox[3 + inGroup.x], gGreatest[inGroup.x]);
    }
    [loop] for (uint s = thread.x; s < gExtent.samples; s += gExtent.threads)
        gSamples[s] = gPoints[s * gExtent.sampleStep];
}
