// SPDX-License-Identifier: GPL-3.0-or-later
// Shadows blurred on the screen (after Rünz 2012, section 6.3): the shadow of a place is its light with shadows by that
// without; its Gaussian mean, weighted by the light without, takes the place of it. A Gaussian is a product of one along
// rows and one along columns: this is run twice.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { BlurConstants gBlur; };
StructuredBuffer<float4> gShadowed : register(t0);  // sums of frames
StructuredBuffer<float4> gLit : register(t1);       // the same without shadows
StructuredBuffer<float4> gHalfway : register(t2);   // of each pixel both, blurred along its row
RWStructuredBuffer<float4> gResult : register(u0);

float4 shadowedAt(uint pixel) {
    if (gBlur.alongColumns == 0u) return gShadowed[pixel];
    return gHalfway[2u * pixel];
}

float4 litAt(uint pixel) {
    if (gBlur.alongColumns == 0u) return gLit[pixel];
    return gHalfway[2u * pixel + 1u];
}

[numthreads(HAIRLOOM_TILE_GROUP, HAIRLOOM_TILE_GROUP, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (any(id.xy >= uint2(gBlur.width, gBlur.height))) return;
    const bool alongRow = gBlur.alongColumns == 0u;
    const int reach = int(gBlur.reach);
    const int last = int(alongRow ? gBlur.width : gBlur.height) - 1;
    const int here = int(alongRow ? id.x : id.y);
    const uint step = alongRow ? 1u : gBlur.width;
    const uint start = alongRow ? id.y * gBlur.width : id.x;
    float4 shadowed = 0;
    float4 lit = 0;
    for (int k = max(here - reach, 0); k <= min(here + reach, last); ++k) {
        const float away = float(k - here);
        const float weight = exp(away * away * gBlur.falloff);
        const uint pixel = start + uint(k) * step;
        shadowed += weight * shadowedAt(pixel);
        lit += weight * litAt(pixel);
    }
    const uint pixel = id.y * gBlur.width + id.x;
    if (alongRow) {
        gResult[2u * pixel] = shadowed;
        gResult[2u * pixel + 1u] = lit;
        return;
    }
    const float4 own = gLit[pixel];
    const float3 share = shadowed.rgb / max(lit.rgb, 1e-20);
    gResult[pixel] = float4(own.rgb * share, gShadowed[pixel].a);
}
