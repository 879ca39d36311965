// SPDX-License-Identifier: GPL-3.0-or-later
// Light of hair that is wider than a pixel, from one side of it to the other: shade_across.hlsli has worked it out.
#ifndef HAIRLOOM_ACROSS_HLSLI
#define HAIRLOOM_ACROSS_HLSLI
#include "shaders/render/pack_light.hlsli"
#include "shaders/shared/render_types.h"

StructuredBuffer<float4> gColour : register(t1);  // of curve points, mean of their width
StructuredBuffer<uint> gAcross : register(t5);    // HAIRLOOM_ACROSS_CELLS a curve point, light from side to side

// Mean light between curve points `first` and the next, `along` from 0 to 1, and from `across` - `reach` to `across` + `reach` from
// side to side, -1 to 1; beyond that lies what hair covers in part.
float3 lightOfHair(ViewConstants view, uint first, float along, float across, float reach) {
    if (view.across == 0u) return lerp(gColour[first].rgb, gColour[first + 1u].rgb, along);
    const float cells = float(HAIRLOOM_ACROSS_CELLS);
    // No less than a cell, so that light is even where a cell is many pixels wide.
    const float most = max(reach * 0.5 * cells, 0.5);
    const float middle = (0.5 + 0.5 * across) * cells;
    const float begin = clamp(middle - most, 0.0, cells - 0.5);
    const float end = clamp(middle + most, begin + 0.5, cells);
    float3 here = 0;
    float3 next = 0;
    for (uint cell = uint(begin); cell < HAIRLOOM_ACROSS_CELLS && float(cell) < end; ++cell) {
        const float part = min(float(cell) + 1.0, end) - max(float(cell), begin);
        here += part * unpackLight(gAcross[first * HAIRLOOM_ACROSS_CELLS + cell]);
        next += part * unpackLight(gAcross[(first + 1u) * HAIRLOOM_ACROSS_CELLS + cell]);
    }
    return lerp(here, next, along) / (end - begin);
}
#endif
