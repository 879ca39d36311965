// SPDX-License-Identifier: GPL-3.0-or-later
// Skin on a round strand: diffuse light that wraps around the terminator, red the farthest, a moist highlight, light that
// shines through the rim, shadows of head and strands.
#include "shaders/render/shadows.hlsli"

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
// Places across the part of the tube that a pixel sees. Highlights and rims are narrower than a pixel where the tube is a
// few pixels wide; seen in one place each they come out as dots.
static const uint kPlaces = 8;

struct Place {
    float3 normal;
    float3 toView;
    float facing;
};

Place placeAt(Input i, float across) {
    Place p;
    p.normal = normalize(across * i.side_ws + sqrt(max(1.0 - across * across, 0.0)) * i.front_ws);
    const float3 position_ws = i.centre_ws.xyz + i.centre_ws.w * p.normal;
    p.toView = normalize(gShade.eye_ws.xyz - position_ws * gShade.eye_ws.w);
    p.facing = saturate(dot(p.normal, p.toView));
    return p;
}

// Light of unit irradiance that a place sends to the eye; `lit` of it arrives from the light's side.
float3 lightFrom(Place p, float3 albedo, float3 toLight, float lit) {
    const float nl = dot(p.normal, toLight);
    const float3 wrap = float3(0.5, 0.3, 0.25);
    const float3 diffuse = saturate((nl + wrap) / ((1 + wrap) * (1 + wrap)));
    const float3 middle = normalize(toLight + p.toView);
    const float fresnel = 0.04 + 0.96 * pow(1.0 - saturate(dot(p.toView, middle)), 5.0);
    // A film of water over rougher skin: two widths of one highlight, each normalised (Blinn and Phong).
    const float m = gShade.primaryExponent;
    const float nh = saturate(dot(p.normal, middle));
    const float wide = 0.125 * m;
    const float highlight = 0.5 * ((m + 8.0) * pow(nh, m) + (wide + 8.0) * pow(nh, wide)) / (8.0 * kPi);
    const float3 specular = gShade.primary.rgb * (10.0 * fresnel * highlight * saturate(nl));
    // Thin at the rim: light from behind comes through, as red as it is deep.
    const float3 through = albedo * (0.35 * pow(1.0 - p.facing, 2.0) * saturate(-dot(toLight, p.toView) + 0.3) / kPi);
    return (albedo / kPi * diffuse + specular) * lit + through * lerp(0.3, 1.0, lit);
}

float3 lightFromAround(Place p, float3 albedo) {
    const float3 mirrored = reflect(-p.toView, p.normal);
    const float fresnel = 0.04 + 0.96 * pow(1.0 - p.facing, 5.0);
    return albedo * environmentOnSkin(gShade, p.normal) +
           fresnel * 3.0 * gShade.primary.rgb * environmentOnSkin(gShade, mirrored);
}

// From where to where across, -1 to 1, the pixel sees the tube. At the rim it is the outermost part as wide as a pixel,
// however little of it is covered: the rim itself may be bright without bounds.
float2 partSeen(float across) {
    const float reach = 0.5 * length(float2(ddx(across), ddy(across)));
    const float maximum = max(1.0 - reach, 0.0);
    const float middle = clamp(across, -maximum, maximum);
    return clamp(float2(middle - reach, middle + reach), -1.0, 1.0);
}

float4 main(Input i) : SV_Target0 {
    const float2 part = partSeen(i.across);
    const Place middle = placeAt(i, 0.5 * (part.x + part.y));
    const float3 position_ws = i.centre_ws.xyz + i.centre_ws.w * middle.normal;
    float3 toLight[HAIRLOOM_MAX_LIGHTS];
    float3 irradiance[HAIRLOOM_MAX_LIGHTS];
    float lit[HAIRLOOM_MAX_LIGHTS];
    float openness = 0;
    for (uint k = 0; k < gShade.lightCount; ++k) {
        const LightConstants light = gShade.lights[k];
        const Occlusion o = occlusionInMap(light, position_ws, 0.0, 0.3 * i.centre_ws.w, 0.002, light.headAbsorption);
        toLight[k] = directionToLight(light, position_ws);
        irradiance[k] = irradianceOf(light, position_ws);
        const Occlusion shadow = shadowOf(light, o);
        lit[k] = shadow.visibility * exp(-kOpacity * shadow.fibres);
        openness += exp(-kOpacity * 0.5 * o.fibres) * lerp(0.25, 1.0, o.visibility);
    }
    openness = gShade.lightCount > 0 ? openness / float(gShade.lightCount) : 1.0;
    float3 colour = 0;
    for (uint n = 0; n < kPlaces; ++n) {
        const Place p = placeAt(i, lerp(part.x, part.y, (float(n) + 0.5) / float(kPlaces)));
        for (uint k = 0; k < gShade.lightCount; ++k) {
            colour += irradiance[k] * lightFrom(p, i.albedo, toLight[k], lit[k]);
        }
        if (hasEnvironment(gShade)) colour += lightFromAround(p, i.albedo) * openness;
    }
    return float4(colour / float(kPlaces), 1);
}
