// SPDX-License-Identifier: GPL-3.0-or-later
// The same light over all of a hair's width, by models that know nothing of its section.
#include "shaders/render/pack_light.hlsli"
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<float4> gMean : register(t4);
RWStructuredBuffer<uint> gAcross : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index >= gShade.count) return;
    const uint light = packLight(gMean[index].rgb);
    for (uint n = 0; n < HAIRLOOM_ACROSS_CELLS; ++n) gAcross[index * HAIRLOOM_ACROSS_CELLS + n] = light;
}
