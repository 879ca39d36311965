// SPDX-License-Identifier: GPL-3.0-or-later
// From the sums of light_grid_trace.comp.hlsl what shading reads: a thread for each cell.
#include "shaders/shared/light_grid_types.h"

cbuffer Grid : register(b4) { LightGridConstants gGrid; };
StructuredBuffer<uint> gCells : register(t0);
StructuredBuffer<uint> gSums : register(t1);
RWStructuredBuffer<float4> gShown : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint cell = id.x + id.y * gGrid.rowThreads;
    if (id.x >= gGrid.rowThreads || cell >= gGrid.count) return;
    const uint first = cell * HAIRLOOM_GRID_LIGHT_WORDS;
    const uint held = cell * HAIRLOOM_GRID_CELL_WORDS;
    const float3 sum = float3(float(gSums[first]), float(gSums[first + 1u]), float(gSums[first + 2u]));
    const float3 way = float3(float(int(gSums[first + 3u])), float(int(gSums[first + 4u])), float(int(gSums[first + 5u])));
    const float mean = max(dot(sum, 1.0 / 3.0), 1e-6);
    // A photon's way through the cell in cells, by its volume.
    const float side = gGrid.origin_ws.w;
    const float unit = gGrid.power / (gGrid.lightUnit * side * side);
    const float square = gCells[held] == 0u ? -1.0 : float(gSums[first + 6u]) / mean;
    const float own = float(gCells[held + HAIRLOOM_GRID_SKIN]) / (gGrid.skinUnit * side * side);
    // Few photons meet the skin of a cell: that of its neighbours counts as well.
    float3 skin = 0;
    float area = 0;
    const int3 size = int3(int(gGrid.sizeX), int(gGrid.sizeY), int(gGrid.sizeZ));
    const int3 at = int3(int(cell % gGrid.sizeX), int(cell / gGrid.sizeX % gGrid.sizeY), int(cell / gGrid.sizeX / gGrid.sizeY));
    for (uint i = 0u; i < 27u && own > 0.0; ++i) {
        const int3 beside = at + int3(int(i % 3u) - 1, int(i / 3u % 3u) - 1, int(i / 9u) - 1);
        if (any(beside < int3(0, 0, 0)) || any(beside >= size)) continue;
        const uint other = uint(beside.x) + gGrid.sizeX * (uint(beside.y) + gGrid.sizeY * uint(beside.z));
        const uint sums = other * HAIRLOOM_GRID_LIGHT_WORDS + 7u;
        skin += float3(float(gSums[sums]), float(gSums[sums + 1u]), float(gSums[sums + 2u]));
        area += float(gCells[other * HAIRLOOM_GRID_CELL_WORDS + HAIRLOOM_GRID_SKIN]);
    }
    const uint shown = cell * HAIRLOOM_GRID_FLOATS;
    gShown[shown] = float4(sum * unit, square);
    gShown[shown + 1u] = float4(way / mean, 0.0);
    gShown[shown + 2u] = float4(skin * (gGrid.power * gGrid.skinUnit / (gGrid.lightUnit * max(area, 1.0))), own);
}
