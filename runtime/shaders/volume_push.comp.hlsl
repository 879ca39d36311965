// SPDX-License-Identifier: MIT
// Gives each free point what the nodes around it say.
#include "volume_points.hlsli"
#include "rod_types.h"

StructuredBuffer<uint> gBox : register(t3);
StructuredBuffer<float4> gFields : register(t4);
RWStructuredBuffer<float> gState : register(u0);
RWStructuredBuffer<float> gRests : register(u1);
RWStructuredBuffer<float> gRodState : register(u2);  // see rod_storage.hlsli

// Planes of velocity and velocityBefore.
#define ROD_VELOCITY 10

void pushRod(Point at, float3 change) {
    [unroll] for (uint axis = 0; axis < 6; ++axis)
        gRodState[planeSlot(ROD_VELOCITY + axis, at)] += change[axis % 3];
    gRodState[(HAIRLOOM_ROD_STATE_PLANES * gVolume.points + 1) * gVolume.slots + at.slot] = HAIRLOOM_ROD_NO_ENERGY;
}

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const Point at = pointOf(thread.x);
    if (!at.counts || at.p < gVolume.clampedPoints) return;
    const float3 here = float3(gState[planeSlot(0, at)], gState[planeSlot(1, at)], gState[planeSlot(2, at)]);
    const float3 before = float3(gState[planeSlot(3, at)], gState[planeSlot(4, at)], gState[planeSlot(5, at)]);
    const float3 position = rootOf(at) + here;
    const float3 velocity = (here - before) / gVolume.h;
    if (!takesPart(position, velocity)) return;
    uint box[8];
    [unroll] for (uint i = 0; i < 8; ++i) box[i] = gBox[i];
    const Grid grid = gridOf(box);
    const Place place = placeOf(position, grid);
    float3 around = float3(0, 0, 0), push = float3(0, 0, 0);
    [loop] for (uint corner = 0; corner < 8; ++corner) {
        const float weight = float(weightOf(place, corner)) * (1.0 / 16777216.0);
        const uint node = nodeOf(place, corner, grid);
        around += gFields[2 * node].xyz * weight;
        push += gFields[2 * node + 1].xyz * weight;
    }
    // A push moves no point farther than half a cell in the frame.
    const float limit = 0.5 * grid.cell / gVolume.dt, kick = sqrt(dot(push, push)) * gVolume.dt;
    float3 change = (around - velocity) * gVolume.share;
    if (kick > 0.0) change += push * (gVolume.dt * min(1.0, limit / kick));
    if (!isSound(change) || all(change == float3(0, 0, 0))) return;
    [unroll] for (uint axis = 0; axis < 3; ++axis)
        gState[planeSlot(3 + axis, at)] = before[axis] - change[axis] * gVolume.h;
    if (gVolume.rods != 0u) pushRod(at, change);
    if (gVolume.sleeps != 0u) {
        const uint rest = HAIRLOOM_REST_NUMBERS * (at.slot / HAIRLOOM_GROUP_STRANDS);
        [unroll] for (uint n = 0; n < HAIRLOOM_REST_NUMBERS; ++n) gRests[rest + n] = 0.0;
    }
}
