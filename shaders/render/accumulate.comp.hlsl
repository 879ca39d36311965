// SPDX-License-Identifier: GPL-3.0-or-later
// Adds one frame to the sum.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { ResolveConstants gResolve; };
Texture2D<float4> gFrame : register(t0);
RWStructuredBuffer<float4> gSum : register(u0);

[numthreads(HAIRLOOM_TILE_GROUP, HAIRLOOM_TILE_GROUP, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gResolve.rowThreads || id.x + id.y * gResolve.rowThreads >= gResolve.pixels) return;
    const uint pixel = id.x + id.y * gResolve.rowThreads;
    const float4 light = gFrame.Load(int3(int2(id.xy), 0));
    gSum[pixel] = gResolve.sumBegins != 0u ? light : gSum[pixel] + light;
}
