// SPDX-License-Identifier: MIT
// Where hair begins in each column of the lamp's grid.
#include "lamp_grid.hlsli"
#include "ribbon_types.h"

cbuffer View : register(b0) { RibbonView gView; };
cbuffer Lamp : register(b1) { HairLamp gLamp; };
StructuredBuffer<float4> gHairs : register(t0);
StructuredBuffer<RibbonLook> gLooks : register(t1);
RWStructuredBuffer<uint> gCrossed : register(u0);

void visitPiece(Columns columns, float depth, float covered) {
    const uint nearness = nearnessOf(depth);
    InterlockedMax(gCrossed[firstAt(columns.at.x)], nearness);
    InterlockedMax(gCrossed[firstAt(columns.at.y)], nearness);
    InterlockedMax(gCrossed[firstAt(columns.at.z)], nearness);
    InterlockedMax(gCrossed[firstAt(columns.at.w)], nearness);
}
#include "lamp_hairs.hlsli"

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) { visitPieces(thread.y * (65535u * 64u) + thread.x); }
