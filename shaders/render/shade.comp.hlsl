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

static const float kPi = 3.14159265;

float3 tilt(float3 tangent, float3 toView, float amount) {
    const float3 normal = toView - tangent * dot(toView, tangent);
    return normalize(tangent + normal * (amount * rsqrt(max(dot(normal, normal), 1e-8))));
}

// How wide a fibre is across the view, of one that is as thick as a round one and turned by `turn` of half a circle.
float sideOf(float axisRatio, float turn) {
    if (axisRatio == 1.0) return 1.0;
    const float c = cos(kPi * turn);
    return sqrt(axisRatio * c * c + (1.0 - c * c) / axisRatio);
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
    const float jitter = (hashUnit(p.strand * 2u + 1u) - 0.5) * 0.06;
    const float3 tangent1 = tilt(tangent, toView, gShade.primaryTilt + jitter);
    const float3 tangent2 = tilt(tangent, toView, gShade.secondaryTilt + jitter);
    const float sparkle = (0.6 + 0.8 * hashUnit(p.strand * 2u)) * sideOf(gShade.axisRatio, hashUnit(p.strand * 2u + 7u));
    // A fibre dims what passes it the more, the darker it is.
    const float3 passed = saturate(1.0 - gShade.fibreOpacity * (1.0 - 0.75 * sqrt(albedo)));

    // What each term sends out in all; that of light between fibres lacks the half of a closed fibre's 1 / pi^2.
    const float3 weights = gShade.primary.rgb + (gShade.diffuse + sparkle * gShade.secondary.rgb) * albedo +
                           kPi * gShade.scattering * albedo * albedo;
    const float bound = gShade.bounded != 0 ? kajiyaBound(weights) : 1.0;

    float3 colour = 0;
    for (uint i = 0; i < gShade.lightCount; ++i) {
        const LightConstants light = gShade.lights[i];
        const float3 toLight = directionToLight(light, p.position_ws.xyz);
        const Occlusion shadow =
            shadowOf(light, occlusion(light, p.position_ws.xyz, tangent, p.position_ws.w, 0.004, light.headAbsorption));
        const float3 direct = pow(passed, shadow.fibres) * shadow.visibility;
        const float3 scattered = pow(passed, 0.5 * shadow.fibres) * lerp(0.15, 1.0, shadow.visibility);
        const float diffuse = kajiyaDiffuse(tangent, toLight);
        const float3 lobe1 = gShade.primary.rgb * (gShade.primaryNormalisation *
                             kajiyaSpecular(tangent1, toLight, toView, gShade.primaryExponent));
        const float3 lobe2 = gShade.secondary.rgb * albedo * (sparkle * gShade.secondaryNormalisation *
                             kajiyaSpecular(tangent2, toLight, toView, gShade.secondaryExponent));
        const float3 single = (gShade.diffuse * gShade.diffuseNormalisation * albedo + lobe1 + lobe2) * diffuse;
        // Light that has bounced between fibres before: an artist's term after Zinke et al. 2008, not derived.
        const float3 multiple = gShade.scattering * albedo * albedo * diffuse / kPi;
        colour += irradianceOf(light, p.position_ws.xyz) * (bound * (single * direct + multiple * scattered));
    }
    if (hasEnvironment(gShade)) {
        SkyInHair sky = openSky();
        if (mapsTellTheSky(gShade)) {
            const SkySeen seen = seenAt(gSeen, strand, p.strand, index, gShade.subdivisions);
            FibreMoments fibre;
            fibre.albedo = albedo;
            fibre.first = fibre.second = 0;
            sky = skyInHair(seen, fibre, gShade.ground.rgb);
        }
        colour += albedo * environmentOnHair(gShade, tangent, sky);
    }
#ifdef HAIRLOOM_LOOK
    colour += emissionAt(p.along);
#endif
    gColour[index] = float4(colour, 1);
}
