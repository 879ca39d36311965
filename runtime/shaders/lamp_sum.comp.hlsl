// SPDX-License-Identifier: MIT
// Fibres from the lamp to the end of each cell, a thread a column, and the counts back to 0 for the next frame.
#include "lamp_grid.hlsli"

RWStructuredBuffer<uint> gCrossed : register(u0);
RWStructuredBuffer<float> gFibres : register(u1);

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const uint column = thread.x;
    if (column >= HAIR_COLUMNS * HAIR_COLUMNS) return;
    uint sum = 0u;
    for (uint slice = 0u; slice < HAIR_SLICES; ++slice) {
        const uint cell = cellAt(column, slice);
        sum += gCrossed[cell];
        gCrossed[cell] = 0u;
        gFibres[cell] = float(sum) / FIBRE_COUNT;
    }
    const uint first = firstAt(column);
    gFibres[first] = depthOf(gCrossed[first]);
    gCrossed[first] = 0u;
}
