// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the sky and of the head each curve point sees. Neither lights nor the camera change it.
#include "shaders/sky_maps.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
RWStructuredBuffer<SkyPoint> gSeen : register(u0);

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.counts.z;
    if (id.x >= gShade.counts.z || index >= gShade.counts.x) return;
    gSeen[index] = skySeen(gShade, gCurve[index].position_ws.xyz);
}
