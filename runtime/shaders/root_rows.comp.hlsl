// SPDX-License-Identifier: MIT
// Roots as the device has found them, in the order of a batch's slots: a thread a slot.
#include "live_types.h"

cbuffer Constants : register(b0) { RootRowConstants gRows; };
StructuredBuffer<float4> gFrames : register(t0);      // of strands: position; rotation
StructuredBuffer<uint> gStrandOfSlot : register(t1);
RWStructuredBuffer<float4> gRootsTo : register(u0);   // of slots, as in storage.hlsli

[numthreads(HAIRLOOM_LIVE_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    if (thread.x >= gRows.slots) return;
    const uint strand = gStrandOfSlot[thread.x];
    gRootsTo[2 * thread.x] = float4(gFrames[2 * strand].xyz, gRows.moved);
    gRootsTo[2 * thread.x + 1] = gFrames[2 * strand + 1];
}
