// SPDX-License-Identifier: MIT
// The box of all points, and how fast they are at most.
#include "volume_points.hlsli"

StructuredBuffer<float> gState : register(t3);
RWStructuredBuffer<uint> gBox : register(u0);

groupshared uint gGroupBox[8];

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID, uint lane : SV_GroupIndex) {
    if (lane < 8) gGroupBox[lane] = lane < BOX_HIGH ? 0xffffffffu : 0u;
    GroupMemoryBarrierWithGroupSync();
    const Point at = pointOf(thread.x);
    if (at.counts) {
        const float3 here = float3(gState[planeSlot(0, at)], gState[planeSlot(1, at)], gState[planeSlot(2, at)]);
        const float3 before = float3(gState[planeSlot(3, at)], gState[planeSlot(4, at)], gState[planeSlot(5, at)]);
        const float3 position = rootOf(at) + here;
        const float3 velocity = (here - before) / gVolume.h;
        if (takesPart(position, velocity)) {
            [unroll] for (uint axis = 0; axis < 3; ++axis) {
                InterlockedMin(gGroupBox[BOX_LOW + axis], sortable(position[axis]));
                InterlockedMax(gGroupBox[BOX_HIGH + axis], sortable(position[axis]));
                InterlockedMax(gGroupBox[BOX_FASTEST], asuint(min(abs(velocity[axis]), FASTEST)));
            }
            InterlockedAdd(gGroupBox[BOX_POINTS], 1u);
        }
    }
    GroupMemoryBarrierWithGroupSync();
    if (lane >= 8 || gGroupBox[BOX_POINTS] == 0u) return;
    if (lane < BOX_HIGH) {
        InterlockedMin(gBox[lane], gGroupBox[lane]);
    } else if (lane < BOX_POINTS) {
        InterlockedMax(gBox[lane], gGroupBox[lane]);
    } else {
        InterlockedAdd(gBox[lane], gGroupBox[lane]);
    }
}
