// SPDX-License-Identifier: GPL-3.0-or-later
// Albedo of each curve point: what strands that are shaded as tubes once a pixel take, and what a picture's layers tell. Of
// light in fibres it is the colour that much of such hair has; with HAIRLOOM_LOOK it changes from place to place.
#include "shaders/render/curve.hlsli"
#ifdef HAIRLOOM_LOOK
#include "shaders/render/point_dye.hlsli"
#endif

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
RWStructuredBuffer<float4> gAlbedo : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index >= gShade.count) return;
    const CurvePoint p = gCurve[index];
    const StrandHeader strand = gStrands[p.strand];
    const float vary = 1.0 + gShade.brightnessVariation * (strand.random * 2.0 - 1.0);
#ifdef HAIRLOOM_LOOK
    float3 albedo = lookAt(placeOf(strand, p.along));
    // Chiang et al. 2016, as lookAt() has it the other way.
    if (gLook.absorbs > 0) albedo = exp(-sqrt(albedo) / gLook.ownScale);
#else
    const float3 own = strand.albedo.w > 0 ? strand.albedo.rgb : gShade.albedo.rgb;
    const float3 albedo = own * lerp(gShade.rootBrightness, gShade.tipBrightness, p.along);
#endif
    gAlbedo[index] = float4(saturate(albedo * vary), 1);
}
