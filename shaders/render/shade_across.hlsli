// SPDX-License-Identifier: GPL-3.0-or-later
// Light leaving each part of a curve point's width, for hair that is wider than a pixel: what shading has found is its mean, and
// the paths of light inside the fibre say which parts of the width are brighter. Only of lamps: light from around, and from other
// hairs, comes from too many sides to tell. shade_across.comp.hlsl is for models that know nothing of a section.
#include "shaders/render/across_fibre.hlsli"
#include "shaders/render/curve.hlsli"
#include "shaders/render/fibre_look.hlsli"
#include "shaders/render/marschner.hlsli"
#include "shaders/render/pack_light.hlsli"
#include "shaders/render/shadows.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
cbuffer Fibre : register(b1) { FibreConstants gFibre; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
StructuredBuffer<float4> gMean : register(t4);
RWStructuredBuffer<uint> gAcross : register(u0);

// Against the view's, around the tangent, towards cross(tangent, toView), where ribbons have their second side.
float azimuthOf(float3 toLight, float3 toView, float3 tangent) {
    const float3 side = cross(tangent, toView);
    return atan2(dot(toLight, side), dot(toLight, toView) - dot(toLight, tangent) * dot(toView, tangent));
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index >= gShade.count) return;
    const CurvePoint p = gCurve[index];
    const StrandHeader strand = gStrands[p.strand];
    const float3 tangent = unpackUnit(p.tangentXy);
    const float3 toView = normalize(gShade.eye_ws.xyz - p.position_ws.xyz * gShade.eye_ws.w);
    const FibreLook look = fibreLookAt(gShade, strand, p.along);
#ifdef HAIRLOOM_LOOK
    const float3 absorption = look.absorption;
#else
    const float3 absorption = gFibre.absorption.rgb;
#endif
    float3 more[HAIRLOOM_ACROSS_CELLS];
    for (uint c = 0; c < HAIRLOOM_ACROSS_CELLS; ++c) more[c] = gMean[index].rgb;
    for (uint i = 0; i < gShade.lightCount; ++i) {
        const LightConstants light = gShade.lights[i];
        const LightConstants close = gShade.closeMaps[uint(light.closeMap)];
        const float3 toLight = directionToLight(light, p.position_ws.xyz);
        const Occlusion shadow = shadowOf(
            light, occlusion(light, close, p.position_ws.xyz, tangent, p.position_ws.w * gShade.ownWidth, 0.004, light.headAbsorption));
        const float3 reached = irradianceOf(light, p.position_ws.xyz) * (shadow.visibility * shadow.direct * gShade.acrossShare);
        if (max(reached.x, max(reached.y, reached.z)) <= 0.0) continue;
        const FibreFrame f = fibreFrame(tangent, toLight, toView);
        const FibreLobes lobes = fibreLobes(gFibre, f, look.tint, look.absorption);
        const float thetaD = 0.5 * (asin(clamp(f.sinOut, -1.0, 1.0)) - asin(clamp(f.sinIn, -1.0, 1.0)));
        const AcrossWeights w =
            acrossWeights(gFibre.ior, gFibre.azimuthalWidth, absorption, azimuthOf(toLight, toView, tangent), sin(thetaD));
        for (uint k = 0; k < HAIRLOOM_ACROSS_CELLS; ++k)
            more[k] += reached * (lobes.reflected * (w.reflected[k] - 1.0) + lobes.through * (w.through[k] - 1.0) +
                                  lobes.returned * (w.returned[k] - 1.0));
    }
    for (uint n = 0; n < HAIRLOOM_ACROSS_CELLS; ++n) gAcross[index * HAIRLOOM_ACROSS_CELLS + n] = packLight(more[n]);
}
