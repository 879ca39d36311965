// SPDX-License-Identifier: GPL-3.0-or-later
// Light leaving each curve point towards the camera. Kajiya-Kay does not change across a ribbon, so shading once per
// point, not per pixel and frame, loses nothing.
#include "shaders/render/curve.hlsli"
#include "kajiya.hlsli"
#include "shaders/render/shadows.hlsli"
#include "shaders/render/sky_in_hair.hlsli"
#ifdef HAIRLOOM_LOOK
#include "shaders/render/point_dye.hlsli"
#endif

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<CurvePoint> gCurve : register(t0);
StructuredBuffer<StrandHeader> gStrands : register(t1);
StructuredBuffer<SkyPoint> gSeen : register(t3);
RWStructuredBuffer<float4> gColour : register(u0);

KajiyaTerms termsOf(ShadeConstants shade) {
    KajiyaTerms terms;
    terms.primary = shade.primary.rgb;
    terms.secondary = shade.secondary.rgb;
    terms.primaryExponent = shade.primaryExponent;
    terms.secondaryExponent = shade.secondaryExponent;
    terms.primaryNormalisation = shade.primaryNormalisation;
    terms.secondaryNormalisation = shade.secondaryNormalisation;
    terms.diffuseNormalisation = shade.diffuseNormalisation;
    terms.diffuse = shade.diffuse;
    terms.scattering = shade.scattering;
    terms.bounded = shade.bounded != 0;
    return terms;
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gShade.rowThreads;
    if (id.x >= gShade.rowThreads || index >= gShade.count) return;
    const CurvePoint p = gCurve[index];
    const StrandHeader strand = gStrands[p.strand];
    const float3 tangent = unpackUnit(p.tangentXy);
    const float3 toView = normalize(gShade.eye_ws.xyz - p.position_ws.xyz * gShade.eye_ws.w);

    const float vary = 1.0 + gShade.brightnessVariation * (strand.random * 2.0 - 1.0);
#ifdef HAIRLOOM_LOOK
    const float3 albedo = saturate(lookAt(placeOf(strand, p.along)) * vary);
#else
    const float3 own = strand.albedo.w > 0 ? strand.albedo.rgb : gShade.albedo.rgb;
    const float3 albedo = saturate(own * lerp(gShade.rootBrightness, gShade.tipBrightness, p.along) * vary);
#endif
    const KajiyaTerms terms = termsOf(gShade);
    const KajiyaFibre fibre =
        kajiyaFibre(p.strand, tangent, toView, albedo, float2(gShade.primaryTilt, gShade.secondaryTilt), gShade.axisRatio);
    const float3 passed = kajiyaPassed(gShade.fibreOpacity, albedo);
    const float bound = kajiyaBoundOf(terms, fibre);

    float3 colour = 0;
    for (uint i = 0; i < gShade.lightCount; ++i) {
        const LightConstants light = gShade.lights[i];
        const LightConstants close = gShade.closeMaps[uint(light.closeMap)];
        const float3 toLight = directionToLight(light, p.position_ws.xyz);
        const Occlusion shadow =
            shadowOf(light, occlusion(light, close, p.position_ws.xyz, tangent, p.position_ws.w * gShade.ownWidth, 0.004, light.headAbsorption));
        const float3 direct = pow(passed, shadow.directFibres) * shadow.visibility;
        const float3 scattered = pow(passed, 0.5 * shadow.fibres) * lerp(0.15, 1.0, shadow.visibility);
        const float3 single = kajiyaSingle(terms, fibre, toLight, toView);
        const float3 multiple = kajiyaMultiple(terms, fibre, toLight);
        colour += irradianceOf(light, p.position_ws.xyz) * (bound * (single * direct + multiple * scattered));
    }
    if (hasEnvironment(gShade)) {
        SkyInHair sky = openSky();
        if (mapsTellTheSky(gShade)) {
            const SkySeen seen = seenAt(gSeen, strand, p.strand, index, gShade.subdivisions);
            FibreMoments moments;
            moments.albedo = albedo;
            moments.first = moments.second = 0;
            sky = skyInHair(seen, moments, gShade.ground.rgb);
        }
        colour += albedo * environmentOnHair(gShade, tangent, sky);
    }
#ifdef HAIRLOOM_LOOK
    colour += emissionAt(p.along);
#endif
    gColour[index] = float4(colour, 1);
}
