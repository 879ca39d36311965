// SPDX-License-Identifier: GPL-3.0-or-later
// A light's counts as the opacity map that shading reads, in 16-bit shares of 1: its layers and, of deep opacity maps as the last of
// all shares, how near the first hair is (0: there is none).
#include "shaders/render/opacity.hlsli"
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { PackConstants gPack; };
StructuredBuffer<uint> gFirst : register(t0);
StructuredBuffer<uint> gCounts : register(t1);
RWStructuredBuffer<uint> gOpacity : register(u0);  // gPack.words a texel

[numthreads(HAIRLOOM_TILE_GROUP, HAIRLOOM_TILE_GROUP, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gPack.side || id.y >= gPack.side) return;
    const uint texel = id.y * gPack.side + id.x;
    const uint at = id.y * gPack.atlasWidth + gPack.tileLeft + id.x;
    const bool fixedLayers = gPack.shadows == HAIRLOOM_SHADOWS_OPACITY_MAPS;
    float nearness = 0.0;
    if (!fixedLayers) {
        const float z = asfloat(gFirst[at]);
        nearness = z < 1.0 ? 1.0 - saturate(metresBehindNear(gPack.depthRange, gPack.nearPlane, z) / gPack.depthRange) : 0.0;
    }
    for (uint word = 0u; word < gPack.words; word += 2u) {
        float4 share = float4(0, 0, 0, 0);
        [unroll] for (uint i = 0u; i < 4u; ++i) {
            const uint layer = 2u * word + i;
            if (layer < gPack.layers) share[i] = float(gCounts[texel * gPack.layers + layer]) * (OPACITY_UNIT / FIBRE_COUNT);
        }
        if (!fixedLayers && word + 2u == gPack.words) share.w = nearness;
        const uint2 packed = packShares(share);
        gOpacity[gPack.words * at + word] = packed.x;
        gOpacity[gPack.words * at + word + 1u] = packed.y;
    }
}
