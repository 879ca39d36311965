// SPDX-License-Identifier: GPL-3.0-or-later
// Skin: diffuse light that wraps a little around the terminator, a soft highlight, shadows of head and hair.
#include "runtime/shaders/layer_light.hlsli"
#include "shaders/render/light_grid.hlsli"
#include "shaders/render/shadows.hlsli"
#include "shaders/render/sky_maps.hlsli"

// Lights are read from here: to a function that is given all constants, compilers copy every light, for every pixel.
cbuffer Constants : register(b0) { ShadeConstants gShade; };

// Of the hair over the skin, where it is of fibres and not Kajiya-Kay's.
FibreMoments hairOverSkin(ShadeConstants shade) {
    FibreMoments fibre;
    fibre.albedo = shade.scattered.rgb;
    fibre.first = shade.firstMoment.rgb;
    fibre.second = shade.secondMoment.rgb;
    return fibre;
}

// The share of light that reaches the skin through so many fibres, with what the skin sends back into the hair and the
// hair returns once more.
float3 throughHair(ShadeConstants shade, Occlusion hair, float3 albedo) {
    const float counted = shade.clumping * hair.fibres;
    if (shade.ofFibres == 0) return exp(-shade.scattered.rgb * (shade.clumping * hair.directFibres));
    if (gridTells(shade)) return exp(stoppedBy(hairOverSkin(shade)).share * log(clamp(hair.direct, 1e-9, 1.0)));
    const LayerLight below = lightInLayer(hairOverSkin(shade), counted, counted, albedo);
    const float3 all = below.onward + below.fluence / 3.14159265 + 0.5 * below.flux;
    return max(all - exp(-counted), 0.0) + hair.direct;
}

// Light from around that hair and head let through, weighted by the cosine; with what hair over the skin sends back to it.
float3 skyOnSkin(ShadeConstants shade, float3 position_ws, float3 normal, float3 albedo) {
    const float3 plain = environmentOnSkin(shade, normal);
    if (!mapsTellTheSky(shade)) return plain;
    const bool fibres = shade.ofFibres > 0;
    const Stopped stopped = stoppedBy(hairOverSkin(shade));
    const float3 stopping = fibres ? stopped.share : shade.scattered.rgb;
    const float3 sentOn = fibres ? 1.0 - stopped.lost : 0.0;
    float3 all = 0;
    float3 passed = 0;
    float3 caught = 0;
    float weight = 0;
    for (uint i = 0; i < HAIRLOOM_SKY_MAPS; ++i) {
        const LightConstants map = gSkyMaps.maps[i];
        const float3 d = map.toLight_ws.xyz;
        const float nl = dot(normal, d);
        if (nl <= 0.0) continue;
        const float lift = map.texelSize;
        const SkyRay ray = skyRay(map, position_ws + normal * lift, 0.0, -lift * nl, lift);
        const float3 through = exp(-map.stopping * ray.before * stopping);
        const float3 light = nl * environmentFrom(shade, d);
        all += light;
        passed += light * ray.open * through;
        caught += nl * ray.open * (1.0 - through);
        weight += nl;
    }
    if (gridTells(shade)) return plain * (passed / max(all, 1e-6));
    caught /= max(weight, 1e-6);
    return plain * (passed / max(all, 1e-6)) / (1.0 - 0.5 * caught * sentOn * (1.0 + albedo));
}

float3 skinLight(MeshConstants mesh, float3 position_ws, float3 normal_ws, float3 albedo) {
    const float kPi = 3.14159265;
    const float3 toView = normalize(gShade.eye_ws.xyz - position_ws * gShade.eye_ws.w);
    float3 normal = normalize(normal_ws);
    const bool inside = dot(normal, toView) < 0;
    if (inside) normal = -normal;
    float3 colour = 0;
    for (uint k = 0; k < gShade.lightCount; ++k) {
        const LightConstants light = gShade.lights[k];
        const LightConstants close = gShade.closeMaps[uint(light.closeMap)];
        const float3 toLight = directionToLight(light, position_ws);
        const float nl = dot(normal, toLight);
        const float reached = saturate(nl * 8.0 + 0.6);
        if (reached == 0.0) continue;
        // Lifted, so that the head does not shadow itself; hair counts down to the skin.
        const float lift = 0.002;
        const Occlusion shadow =
            shadowOf(light, occlusion(light, close, position_ws + normal * lift, 0.0, -lift * saturate(nl), 0.002, 0.0));
        // Red light travels farther under the skin. The denominator keeps the energy of a Lambertian.
        const float3 wrap = mesh.wrap * float3(1, 0.5, 0.35);
        const float3 diffuse = saturate((nl + wrap) / ((1 + wrap) * (1 + wrap)));
        const float3 middle = normalize(toLight + toView);
        const float fresnel = 0.04 + 0.96 * pow(1.0 - saturate(dot(toView, middle)), 5.0);
        const float m = mesh.specularExponent;
        const float specular = mesh.specular * fresnel * (m + 8.0) / (8.0 * kPi) *
                               pow(saturate(dot(normal, middle)), m) * saturate(nl);
        const float lit = reached * shadow.visibility;
        colour += irradianceOf(light, position_ws) * (albedo / kPi * diffuse + specular) *
                  (lit * throughHair(gShade, shadow, albedo));
    }
    if (hasEnvironment(gShade)) colour += albedo * skyOnSkin(gShade, position_ws, normal, albedo);
    if (gridTells(gShade) && !inside) colour += albedo / kPi * gridLightOnSkin(gShade, position_ws);
    return colour;
}
