// SPDX-License-Identifier: GPL-3.0-or-later
// Albedo of each curve point of strands that are shaded as tubes, once a pixel; with HAIRLOOM_LOOK it changes from place to
// place.
#include "shaders/render/curve.hlsli"
#ifdef HAIRLOOM_LOOK
#include "shaders/render/point_dye.hlsli"
#endif

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
RWStructuredBuffer<float4> gColour : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index >= gShade.count) return;
    const CurvePoint p = gCurve[index];
    const StrandHeader strand = gStrands[p.strand];
    const float vary = 1.0 + gShade.brightnessVariation * (strand.random * 2.0 - 1.0);
#ifdef HAIRLOOM_LOOK
    const float3 albedo = lookAt(placeOf(strand, p.along));
#else
    const float3 albedo = strand.albedo.w > 0 ? strand.albedo.rgb : gShade.albedo.rgb;
#endif
    gColour[index] = float4(saturate(albedo * vary), 1);
}
