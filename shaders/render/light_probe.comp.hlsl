// SPDX-License-Identifier: GPL-3.0-or-later
// What lights do at given places, for tests.
#include "shaders/render/shadows.hlsli"
#include "shaders/render/sky_in_hair.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<LightCase> gCases : register(t0);
RWStructuredBuffer<LightAnswer> gResults : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint count, stride;
    gCases.GetDimensions(count, stride);
    if (id.x >= count) return;
    const LightCase c = gCases[id.x];
    const Occlusion o = occlusionInMap(gShade.lights[0], c.position_ws.xyz, c.direction.xyz, c.position_ws.w, 0.002,
                                    gShade.lights[0].headAbsorption);
    const SkyShares seen = unpackSky(skySeen(c.position_ws.xyz, c.direction.xyz, c.position_ws.w).whole);
    LightAnswer answer;
    answer.onHair = float4(environmentOnHair(gShade, c.direction.xyz, openSky()), o.fibres);
    answer.onSkin = float4(environmentOnSkin(gShade, c.direction.xyz), o.visibility);
    answer.sky =
        float4(seen.open, seen.blocked, o.passed, 0);
    gResults[id.x] = answer;
}
