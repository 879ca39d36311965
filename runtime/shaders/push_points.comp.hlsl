// SPDX-License-Identifier: MIT
// Leads points of drawn hair out of a body; a thread for each point. Roots stay.
#include "push.hlsli"

StructuredBuffer<uint> gHairs : register(t3);  // of each point, its hair

[numthreads(HAIRLOOM_PUSH_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    // Rows of groups: one dimension of a dispatch is too short for many points.
    const uint p = thread.y * (65535u * HAIRLOOM_PUSH_GROUP) + thread.x;
    if (p >= gPush.points || p == gOffsets[gHairs[p]]) return;
    liftPoint(p);
}
