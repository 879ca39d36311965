// SPDX-License-Identifier: GPL-3.0-or-later
// Adds hair to the cells of the grid that light is followed in: a thread for each curve point, which adds the segment behind it.
#include "shaders/render/curve.hlsli"
#include "shaders/render/dual.hlsli"
#include "shaders/render/fibre_look.hlsli"
#include "shaders/render/light_cells.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
cbuffer Fibre : register(b1) { FibreConstants gFibre; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
RWStructuredBuffer<uint> gCells : register(u0);

static const uint kMostPieces = 4096u;

// Rounded by chance, since a piece may be less than the unit.
void addAt(uint word, float amount, float chance) { InterlockedAdd(gCells[word], uint(int(floor(amount + chance)))); }
void addThree(uint word, float3 amount, float chance) {
    addAt(word, amount.x, chance);
    addAt(word + 1u, amount.y, chance);
    addAt(word + 2u, amount.z, chance);
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index + 1u >= gShade.count) return;
    const CurvePoint p = gCurve[index];
    const CurvePoint q = gCurve[index + 1u];
    if (p.strand != q.strand) return;
    const StrandHeader strand = gStrands[p.strand];
    const FibreLook look = fibreLookAt(gShade, strand, p.along);
    const FibreAverages averages = averagesAt(0.0, look.absorption);
    const FibreMoments moments = tinted(averages.moments, shareOf(averages.moments, look.tint));
    const float3 way = q.position_ws.xyz - p.position_ws.xyz;
    const float metres = length(way);
    if (!(metres > 0.0)) return;
    const float3 tangent = way / metres;
    const float spread = gGrid.spread * gGrid.origin_ws.w;
    const uint pieces = min(uint((spread > 0.0 ? 6.0 : 2.0) * metres / gGrid.origin_ws.w) + 1u, kMostPieces);
    const float each = metres * (p.position_ws.w + q.position_ws.w) * 0.5 * (p.opacity + q.opacity) * gGrid.hairUnit / float(pieces);
    for (uint i = 0u; i < pieces; ++i) {
        const uint chance = hashUint(index * kMostPieces + i);
        float3 at_ws = p.position_ws.xyz + way * ((float(i) + hashUnit(chance)) / float(pieces));
        if (spread > 0.0) {
            const float3 a = float3(hashUnit(chance + 1u), hashUnit(chance + 2u), hashUnit(chance + 3u));
            const float3 b = float3(hashUnit(chance + 4u), hashUnit(chance + 5u), hashUnit(chance + 6u));
            at_ws += spread * (a + b - 1.0);
        }
        const int3 cell = int3(floor((at_ws - gGrid.origin_ws.xyz) / gGrid.origin_ws.w));
        if (!inGrid(cell)) continue;
        const uint first = HAIRLOOM_GRID_CELL_WORDS * cellNumber(cell);
        const float u = hashUnit(chance + 7u);
        addAt(first, each, u);
        addThree(first + HAIRLOOM_GRID_TANGENT, each * tangent, u);
        addThree(first + HAIRLOOM_GRID_ALBEDO, each * moments.albedo, u);
        addThree(first + HAIRLOOM_GRID_FIRST, each * moments.first, u);
        addThree(first + HAIRLOOM_GRID_SECOND, each * moments.second, u);
        addAt(first + HAIRLOOM_GRID_TILT, each * averages.rest.z, u);
        addAt(first + HAIRLOOM_GRID_VARIANCE, each * averages.rest.w, u);
    }
}
