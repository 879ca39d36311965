// SPDX-License-Identifier: GPL-3.0-or-later
// Light leaving each curve point towards the camera, by a model of light in fibres: HAIRLOOM_SADEGHI or Marschner's, with
// HAIRLOOM_DUAL also what other fibres have scattered before, with HAIRLOOM_LOOK for hair that does not absorb the same
// everywhere. shade.comp.hlsl does the same for Kajiya-Kay.
#include "shaders/render/curve.hlsli"
#include "shaders/render/fibre_look.hlsli"
#include "shaders/render/shadows.hlsli"
#include "shaders/render/sky.hlsli"
#ifdef HAIRLOOM_SADEGHI
#include "shaders/render/sadeghi.hlsli"
#else
#include "shaders/render/marschner.hlsli"
#endif
#ifdef HAIRLOOM_DUAL
#include "shaders/render/dual.hlsli"
#include "shaders/render/light_grid.hlsli"
#endif

cbuffer Constants : register(b0) { ShadeConstants gShade; };
cbuffer Fibre : register(b1) { FibreConstants gFibre; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
StructuredBuffer<SkyPoint> gSeen : register(t3);
RWStructuredBuffer<float4> gColour : register(u0);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index >= gShade.count) return;
    const CurvePoint p = gCurve[index];
    const StrandHeader strand = gStrands[p.strand];
    const float3 tangent = unpackUnit(p.tangentXy);
    const float3 toView = normalize(gShade.eye_ws.xyz - p.position_ws.xyz * gShade.eye_ws.w);

    const FibreLook look = fibreLookAt(gShade, strand, p.along);
    const float3 tint = look.tint;
    const float3 absorption = look.absorption;
    float3 colour = 0;
    for (uint i = 0; i < gShade.lightCount; ++i) {
        const LightConstants light = gShade.lights[i];
        const LightConstants close = gShade.closeMaps[uint(light.closeMap)];
        const float3 toLight = directionToLight(light, p.position_ws.xyz);
        const Occlusion o = occlusion(light, close, p.position_ws.xyz, tangent, p.position_ws.w * gShade.ownWidth, 0.004, light.headAbsorption);
        const Occlusion shadow = shadowOf(light, o);
        const FibreFrame f = fibreFrame(tangent, toLight, toView);
        float3 scattered = shadow.direct *
                           fibreScattering(gFibre, f, hashUnit(p.strand * 2u), tint, absorption);
#ifdef HAIRLOOM_DUAL
        if (gridTells(gShade)) scattered += onwardScattering(gFibre, f, shadow.passed, tint, absorption);
        else scattered += multipleScattering(gFibre, f, gShade.clumping * shadow.fibres, gShade.clumping * o.allFibres,
                                             tint, absorption, gShade.ground.rgb * o.ground);
#endif
        colour += irradianceOf(light, p.position_ws.xyz) * shadow.visibility * scattered;
    }
#ifdef HAIRLOOM_DUAL
    const FibreAverages across = averagesAt(0.0, absorption);
    if (gridTells(gShade)) colour += gridScattering(gridLightAt(gShade, p.position_ws.xyz), across, tint, tangent, toView);
#endif
    if (hasEnvironment(gShade)) {
        const SkyMoments fibre = skyMoments(dot(toView, tangent), absorption);
        SkyInHair sky = openSky();
        if (mapsTellTheSky(gShade)) {
            const SkySeen seen = seenAt(gSeen, strand, p.strand, index, gShade.subdivisions);
#ifdef HAIRLOOM_DUAL
            FibreMoments moments = tinted(across.moments, shareOf(across.moments, tint));
            // The grid has the rest.
            if (gridTells(gShade)) moments.albedo = moments.first = moments.second = max(moments.second, 0.0);
            sky = skyInHair(seen, moments, gridTells(gShade) ? 0.0 : gShade.ground.rgb);
#else
            FibreMoments nothing;  // what has met a fibre or the head is lost
            nothing.albedo = nothing.first = nothing.second = 0;
            sky = skyInHair(seen, nothing, 0);
#endif
        }
        colour += tint * environmentOnFibre(gShade, fibre, sky, tangent, toView);
    }
#ifdef HAIRLOOM_LOOK
    colour += emissionAt(p.along);
#endif
    gColour[index] = float4(colour, 1);
}
