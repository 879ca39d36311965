// SPDX-License-Identifier: MIT
// Light of one lamp that leaves each point of each hair towards the eye, as its material says. Hair looks the same across a
// ribbon, so shading once a point, not a pixel, loses nothing.
#include "kajiya.hlsli"
#include "hair_look.hlsli"
#include "lamp_grid.hlsli"
#include "ribbon_types.h"

cbuffer View : register(b0) { RibbonView gView; };
cbuffer Lamp : register(b1) { HairLamp gLamp; };
StructuredBuffer<float4> gHairs : register(t0);
StructuredBuffer<RibbonLook> gLooks : register(t1);
StructuredBuffer<HairShade> gShades : register(t2);
StructuredBuffer<HairMaterial> gMaterials : register(t3);
StructuredBuffer<float> gTables : register(t4);
StructuredBuffer<float> gFibres : register(t5);
RWStructuredBuffer<float4> gColours : register(u0);
#include "hair_fibre.hlsli"

// Fibres up to the lamp, and from one side of the hair to the other.
// A column beside the point is asked at the depth that the fibre comes to on its way there, as hair beside it does.
float2 fibresAt(float3 position, float3 tangent) {
    const float3 place = gridPlace(gLamp, position);
    const float3 way = gridPlace(gLamp, position + tangent) - gridPlace(gLamp, position);
    const float across = dot(way.xy, way.xy);
    const float2 slope = way.xy * (clamp(way.z, -3.0 * sqrt(across), 3.0 * sqrt(across)) / max(across, 1e-12));
    const float own = 0.5 * (abs(slope.x) + abs(slope.y)) / float(HAIR_COLUMNS);
    const Columns c = columnsAround(saturate(place.xy));
    float2 sum = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        const uint column = c.at[i];
        const float2 middle = (float2(column % HAIR_COLUMNS, column / HAIR_COLUMNS) + 0.5) / float(HAIR_COLUMNS);
        const float depth = place.z - own + dot(middle - place.xy, slope);
        const float deep = sliceOf(depth - gFibres[firstAt(column)]);
        const uint slice = min(uint(deep), HAIR_SLICES - 1u);
        const float end = gFibres[cellAt(column, slice)];
        const float begin = slice > 0u ? gFibres[cellAt(column, slice - 1u)] : 0.0;
        sum += c.shares[i] * float2(lerp(begin, end, deep - float(slice)), gFibres[cellAt(column, HAIR_SLICES - 1u)]);
    }
    return sum;
}

float3 kajiyaLight(HairMaterial hair, float3 albedo, uint number, float3 tangent, float3 toView, float fibres) {
    KajiyaTerms terms;
    terms.primary = hair.primary.rgb;
    terms.secondary = hair.secondary.rgb;
    terms.primaryExponent = hair.primary.w;
    terms.secondaryExponent = hair.secondary.w;
    terms.primaryNormalisation = hair.primaryNormalisation;
    terms.secondaryNormalisation = hair.secondaryNormalisation;
    terms.diffuseNormalisation = hair.diffuseNormalisation;
    terms.diffuse = hair.diffuse;
    terms.scattering = hair.scattering;
    terms.bounded = hair.bounded != 0u;
    const KajiyaFibre fibre =
        kajiyaFibre(number, tangent, toView, albedo, float2(hair.primaryTilt, hair.secondaryTilt), hair.axisRatio);
    const float3 passed = kajiyaPassed(hair.fibreOpacity, albedo);
    const float3 toLight = gLamp.toLight.xyz;
    return kajiyaBoundOf(terms, fibre) * (kajiyaSingle(terms, fibre, toLight, toView) * pow(passed, fibres) +
                                          kajiyaMultiple(terms, fibre, toLight) * pow(passed, 0.5 * fibres));
}

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const uint at = thread.y * (65535u * 64u) + thread.x;
    if (at >= gView.hairs * gView.points) return;
    const uint p = at % gView.points, hair = at / gView.points, last = gView.points - 1u, first = hair * gView.points;
    const float3 here = gHairs[at].xyz;
    const float3 along = gHairs[first + min(p + 1u, last)].xyz - gHairs[first + max(p, 1u) - 1u].xyz;
    const float3 tangent = along * rsqrt(max(dot(along, along), 1e-30));
    const float3 toView = normalize(gView.eye.xyz - here);
    const RibbonLook own = gLooks[hair];
    const HairShade shade = gShades[hair];
    const HairMaterial material = gMaterials[shade.material];

    StrandPlace place;
    place.along = float(p) / float(last);
    place.random = hashUnit(shade.number * 2u + 9u);
    place.streak = shade.streak;
    place.dye = shade.dye;
    place.pigment = shade.pigment;
    place.length = shade.length;
    place.own = float4(own.colour.rgb, shade.own);
    const float3 look = lookOf(material.look, place);
    const float vary = 1.0 + material.widths.w * (own.colour.w * 2.0 - 1.0);
    const float2 fibres = fibresAt(here, tangent);
    float3 light;
    if (material.model == HAIR_FIBRE) {
        const float3 white = exp(sqrt(look) / material.look.ownScale);  // times the colour that much such hair has
        const float3 tint = material.bounded != 0u ? min(vary, min(white.x, min(white.y, white.z))) : vary;
        const FibreFrame f = fibreFrame(tangent, gLamp.toLight.xyz, toView);
        light = fibreLight(material, f, material.scales.w * fibres.x, material.scales.w * fibres.y, tint, look, gLamp.ground.rgb);
    } else {
        light = kajiyaLight(material, saturate(look * vary), shade.number, tangent, toView, fibres.x);
    }
    light *= gLamp.light.rgb;
    if (gLamp.light.w > 0.0)
        light += gColours[at].rgb;
    else
        light += emissionOf(material.look, place.along);
    gColours[at] = float4(light, 1);
}
