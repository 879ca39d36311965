// SPDX-License-Identifier: GPL-3.0-or-later
// Look-up tables of the fibre models (core/shading/tables.h).
#ifndef HAIRLOOM_FIBRE_TABLES_HLSLI
#define HAIRLOOM_FIBRE_TABLES_HLSLI
#include "runtime/shaders/fibre.hlsli"
#include "shaders/shared/render_types.h"

SamplerState gLinear : register(s0);
Texture2D<float4> gLongitudinal : register(t11);

// As floats: Wine takes sizes that are asked for as integers for floats, where rounding is strict.
float2 sizeOf(Texture2D<float4> table) {
    float2 size;
    table.GetDimensions(size.x, size.y);
    return size;
}

// Texels stand for both ends of 0 to 1.
float4 lookUp(Texture2D<float4> table, float2 at) {
    const float2 size = sizeOf(table);
    return table.SampleLevel(gLinear, (saturate(at) * (size - 1.0) + 0.5) / size, 0);
}

// M of R, TT and TRT with cos theta_i / cos^2 theta_d, and 2 |theta_d| / pi.
float4 longitudinal(float sinIn, float sinOut) { return lookUp(gLongitudinal, 0.5 * float2(sinIn, sinOut) + 0.5); }
#endif
