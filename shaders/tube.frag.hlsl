// SPDX-License-Identifier: GPL-3.0-or-later
// Skin on a round strand: diffuse light that wraps around the terminator, red the farthest, a moist highlight, light that
// shines through the rim, shadows of head and strands.
#include "shaders/shadows.hlsli"

cbuffer Shade : register(b1) { ShadeConstants gShade; };

static const float kPi = 3.14159265;

struct Input {
    float4 position : SV_Position;
    float3 albedo : COLOR;
    float4 centre_ws : POSITION;
    float3 side_ws : SIDE;
    float3 front_ws : FRONT;
    float across : ACROSS;
};

// A strand is opaque: one in the way takes nearly all light.
static const float kOpacity = 2.5;

float4 main(Input i) : SV_Target0 {
    const float x = clamp(i.across, -1.0, 1.0);
    const float3 normal = normalize(x * i.side_ws + sqrt(1.0 - x * x) * i.front_ws);
    const float3 position_ws = i.centre_ws.xyz + i.centre_ws.w * normal;
    const float3 toView = normalize(gShade.eye_ws.xyz - position_ws * gShade.eye_ws.w);
    const float facing = saturate(dot(normal, toView));
    const float m = gShade.primary.w;
    float3 colour = 0;
    float openness = 0;
    for (uint k = 0; k < gShade.counts.y; ++k) {
        const LightConstants light = gShade.lights[k];
        const float3 toLight = directionToLight(light, position_ws);
        const Occlusion o = occlusion(light, position_ws, 0.3 * i.centre_ws.w, 0.002);
        const float nl = dot(normal, toLight);
        const float3 wrap = float3(0.5, 0.3, 0.25);
        const float3 diffuse = saturate((nl + wrap) / ((1 + wrap) * (1 + wrap)));
        const float3 middle = normalize(toLight + toView);
        const float fresnel = 0.04 + 0.96 * pow(1.0 - saturate(dot(toView, middle)), 5.0);
        // A film of water over rougher skin: two widths of one highlight, each normalised (Blinn and Phong).
        const float nh = saturate(dot(normal, middle));
        const float wide = 0.125 * m;
        const float highlight = 0.5 * ((m + 8.0) * pow(nh, m) + (wide + 8.0) * pow(nh, wide)) / (8.0 * kPi);
        const float3 specular = gShade.primary.rgb * (10.0 * fresnel * highlight * saturate(nl));
        // Thin at the rim: light from behind comes through, as red as it is deep.
        const float3 through = i.albedo * (0.35 * pow(1.0 - facing, 2.0) * saturate(-dot(toLight, toView) + 0.3) / kPi);
        const float lit = o.visibility * exp(-kOpacity * o.fibres);
        colour += irradianceOf(light, position_ws) * ((i.albedo / kPi * diffuse + specular) * lit + through * lerp(0.3, 1.0, lit));
        openness += exp(-kOpacity * 0.5 * o.fibres) * lerp(0.25, 1.0, o.visibility);
    }
    openness = gShade.counts.y > 0 ? openness / float(gShade.counts.y) : 1.0;
    if (hasEnvironment(gShade)) {
        const float3 mirrored = reflect(-toView, normal);
        const float fresnel = 0.04 + 0.96 * pow(1.0 - facing, 5.0);
        colour += (i.albedo * environmentOnSkin(gShade, normal) +
                   fresnel * 3.0 * gShade.primary.rgb * environmentOnSkin(gShade, mirrored)) * openness;
    }
    return float4(colour, 1);
}
