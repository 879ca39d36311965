// SPDX-License-Identifier: GPL-3.0-or-later
// From the sums of light_grid_trace.comp.hlsl what shading reads: a thread for each cell.
#include "shaders/render/light_cells_read.hlsli"

StructuredBuffer<uint> gSums : register(t1);
RWStructuredBuffer<float4> gShown : register(u0);

static const float kManyPhotons = 16.0;  // with their whole light, across a cell

float3 sumsAt(uint word) { return float3(float(gSums[word]), float(gSums[word + 1u]), float(gSums[word + 2u])); }
float3 waysAt(uint word) { return float3(float(int(gSums[word])), float(int(gSums[word + 1u])), float(int(gSums[word + 2u]))); }

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint cell = id.x + id.y * gGrid.rowThreads;
    if (id.x >= gGrid.rowThreads || cell >= gGrid.count) return;
    const uint first = cell * HAIRLOOM_GRID_LIGHT_WORDS;
    const uint held = cell * HAIRLOOM_GRID_CELL_WORDS;
    const float side = gGrid.origin_ws.w;
    const bool hasHair = gCells[held] > 0u;
    const float ownSkin = float(gCells[held + HAIRLOOM_GRID_SKIN]) / (gGrid.skinUnit * side * side);
    float3 light = sumsAt(first);
    float3 way = waysAt(first + 3u);
    float square = float(gSums[first + 6u]);
    // Few photons meet the skin of a cell: that of its neighbours counts as well. So does their hair, where few go through that
    // of the cell.
    float3 skin = 0;
    float skinArea = 0;
    float3 lightAround = 0;
    float3 wayAround = 0;
    float squareAround = 0;
    float weights = 0;
    const int3 at = int3(int(cell % gGrid.sizeX), int(cell / gGrid.sizeX % gGrid.sizeY), int(cell / gGrid.sizeX / gGrid.sizeY));
    for (uint i = 0u; i < 27u && (hasHair || ownSkin > 0.0); ++i) {
        const int3 aside = int3(int(i % 3u) - 1, int(i / 3u % 3u) - 1, int(i / 9u) - 1);
        const int3 beside = at + aside;
        if (!inGrid(beside)) continue;
        const uint other = cellNumber(beside);
        const uint sums = other * HAIRLOOM_GRID_LIGHT_WORDS;
        const uint holds = other * HAIRLOOM_GRID_CELL_WORDS;
        // Photons that come to a fold end there.
        const float area = float(gCells[holds + HAIRLOOM_GRID_SKIN]);
        if (!isFolded(threeAt(holds + HAIRLOOM_GRID_SKIN + 1u), area)) {
            skin += sumsAt(sums + 7u);
            skinArea += area;
        }
        if (gCells[holds] == 0u) continue;
        const float weight = (aside.x == 0 ? 2.0 : 1.0) * (aside.y == 0 ? 2.0 : 1.0) * (aside.z == 0 ? 2.0 : 1.0);
        lightAround += weight * sumsAt(sums);
        wayAround += weight * waysAt(sums + 3u);
        squareAround += weight * float(gSums[sums + 6u]);
        weights += weight;
    }
    if (weights > 0.0) {
        const float photons = dot(light, 1.0 / 3.0) / gGrid.lightUnit;
        const float around = 1.0 / (1.0 + photons / kManyPhotons);
        light = lerp(light, lightAround / weights, around);
        way = lerp(way, wayAround / weights, around);
        square = lerp(square, squareAround / weights, around);
    }
    const float mean = max(dot(light, 1.0 / 3.0), 1e-6);
    // A photon's way through the cell in cells, by its volume.
    const float unit = gGrid.power / (gGrid.lightUnit * side * side);
    const uint shown = cell * HAIRLOOM_GRID_FLOATS;
    gShown[shown] = float4(light * unit, hasHair ? square / mean : -1.0);
    gShown[shown + 1u] = float4(way / mean, 0.0);
    gShown[shown + 2u] = float4(skin * (gGrid.power * gGrid.skinUnit / (gGrid.lightUnit * max(skinArea, 1.0))), ownSkin);
}
