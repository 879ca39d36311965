// SPDX-License-Identifier: GPL-3.0-or-later
// What lights do at given places, for tests: two results a place, light from around for a fibre with fibres in front of
// it in w, and light from around for a surface with what the head lets through in w.
#include "shaders/shadows.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<LightCase> gCases : register(t0);
RWStructuredBuffer<float4> gResults : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint count, stride;
    gCases.GetDimensions(count, stride);
    if (id.x >= count) return;
    const LightCase c = gCases[id.x];
    const Occlusion o = occlusion(gShade.lights[0], c.position_ws.xyz, c.position_ws.w, 0.002, gShade.lights[0].filtering.z);
    gResults[2 * id.x] = float4(environmentOnHair(gShade, c.direction.xyz, 0), o.fibres);
    gResults[2 * id.x + 1] = float4(environmentOnSkin(gShade, c.direction.xyz), o.visibility);
}
