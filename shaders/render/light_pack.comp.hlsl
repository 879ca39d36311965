// SPDX-License-Identifier: GPL-3.0-or-later
// A light's counts as the opacity map that shading reads: four 16-bit shares of 1, three layers and how near the first
// hair is (0: there is none), or four layers.
#include "shaders/render/opacity.hlsli"
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { PackConstants gPack; };
StructuredBuffer<uint> gFirst : register(t0);
StructuredBuffer<uint> gCounts : register(t1);
RWStructuredBuffer<uint> gOpacity : register(u0);  // two words a texel

[numthreads(HAIRLOOM_TILE_GROUP, HAIRLOOM_TILE_GROUP, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gPack.side || id.y >= gPack.side) return;
    const uint texel = id.y * gPack.side + id.x;
    const uint at = id.y * gPack.atlasWidth + gPack.tileLeft + id.x;
    const bool fixedLayers = gPack.shadows == HAIRLOOM_SHADOWS_OPACITY_MAPS;
    const uint layers = fixedLayers ? 4u : 3u;
    const uint counts = texel * layers;
    float4 share = float4(gCounts[counts], gCounts[counts + 1u], gCounts[counts + 2u], 0);
    if (fixedLayers) share.w = float(gCounts[counts + 3u]);
    share *= OPACITY_UNIT / FIBRE_COUNT;
    if (!fixedLayers) {
        const float z = asfloat(gFirst[at]);
        share.w = z < 1.0 ? 1.0 - saturate(metresBehindNear(gPack.depthRange, gPack.nearPlane, z) / gPack.depthRange) : 0.0;
    }
    const uint2 packed = packShares(share);
    gOpacity[2u * at] = packed.x;
    gOpacity[2u * at + 1u] = packed.y;
}
