// SPDX-License-Identifier: MIT
// Counts all hair in the cells of the lamp's grid that it lies in.
#include "lamp_grid.hlsli"
#include "ribbon_types.h"

cbuffer View : register(b0) { RibbonView gView; };
cbuffer Lamp : register(b1) { HairLamp gLamp; };
StructuredBuffer<float4> gHairs : register(t0);
StructuredBuffer<RibbonLook> gLooks : register(t1);
RWStructuredBuffer<uint> gCrossed : register(u0);

void count(uint column, float depth, float amount) {
    const float slice = sliceOf(depth - depthOf(gCrossed[firstAt(column)]));
    InterlockedAdd(gCrossed[cellAt(column, min(uint(slice), HAIR_SLICES - 1u))], uint(amount));
}

void visitPiece(Columns columns, float depth, float covered) {
    const float4 whole = floor(covered * FIBRE_COUNT * columns.shares + 0.5);
    count(columns.at.x, depth, whole.x);
    count(columns.at.y, depth, whole.y);
    count(columns.at.z, depth, whole.z);
    count(columns.at.w, depth, whole.w);
}
#include "lamp_hairs.hlsli"

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) { visitPieces(thread.y * (65535u * 64u) + thread.x); }
