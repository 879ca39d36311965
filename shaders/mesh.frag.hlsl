// SPDX-License-Identifier: GPL-3.0-or-later
// Skin: diffuse light that wraps a little around the terminator, a soft highlight, shadows of head and hair.
#include "shaders/shadows.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
cbuffer Mesh : register(b1) { MeshConstants gMesh; };

static const float kPi = 3.14159265;

struct Input {
    float4 position : SV_Position;
    float3 position_ws : POSITION;
    float3 normal_ws : NORMAL;
    nointerpolation float3 albedo : ALBEDO;
};

float4 main(Input i) : SV_Target0 {
    const float3 toView = normalize(gShade.eye_ws.xyz - i.position_ws);
    float3 normal = normalize(i.normal_ws);
    if (dot(normal, toView) < 0) normal = -normal;
    float3 colour = 0;
    float openness = 0;
    for (uint k = 0; k < gShade.counts.y; ++k) {
        const LightConstants light = gShade.lights[k];
        const float3 toLight = directionToLight(light, i.position_ws);
        const Occlusion o = occlusion(light, i.position_ws + normal * 0.002, 0.0, 0.002);
        const float nl = dot(normal, toLight);
        // Red light travels farther under the skin. The denominator keeps the energy of a Lambertian.
        const float3 wrap = gMesh.skin.x * float3(1, 0.5, 0.35);
        const float3 diffuse = saturate((nl + wrap) / ((1 + wrap) * (1 + wrap)));
        const float3 middle = normalize(toLight + toView);
        const float fresnel = 0.04 + 0.96 * pow(1.0 - saturate(dot(toView, middle)), 5.0);
        const float m = gMesh.skin.z;
        const float specular = gMesh.skin.y * fresnel * (m + 8.0) / (8.0 * kPi) *
                               pow(saturate(dot(normal, middle)), m) * saturate(nl);
        const float lit = lerp(0.0, o.visibility, saturate(nl * 8.0 + 0.6));
        colour += irradianceOf(light, i.position_ws) * (i.albedo / kPi * diffuse + specular) * (lit * exp(-0.5 * o.fibres));
        openness += exp(-0.3 * o.fibres);
    }
    openness = gShade.counts.y > 0 ? openness / float(gShade.counts.y) : 1.0;
    if (hasEnvironment(gShade)) colour += i.albedo * environmentOnSkin(gShade, normal) * openness;
    return float4(colour, 1);
}
