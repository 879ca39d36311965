// SPDX-License-Identifier: GPL-3.0-or-later
// Directional lights, point lights, and light from all around.
#ifndef HAIRLOOM_LIGHTS_HLSLI
#define HAIRLOOM_LIGHTS_HLSLI
#include "shaders/shared/render_types.h"

float3 directionToLight(LightConstants light, float3 position_ws) {
    return light.toLight_ws.w > 0 ? normalize(light.toLight_ws.xyz - position_ws) : light.toLight_ws.xyz;
}

// Irradiance perpendicular to the light.
float3 irradianceOf(LightConstants light, float3 position_ws) {
    const float3 d = light.toLight_ws.xyz - position_ws;
    const float squared = max(dot(d, d), 1e-6);
    const bool all = dot(light.facing_ws.xyz, light.facing_ws.xyz) == 0.0;
    const float facing = all ? 1.0 : max(-dot(light.facing_ws.xyz, d) * rsqrt(squared), 0.0);
    return light.toLight_ws.w > 0 ? light.irradiance.rgb * (facing / squared) : light.irradiance.rgb;
}

bool hasEnvironment(ShadeConstants shade) { return shade.hasEnvironment > 0; }

// Light from around in a direction, band by band.
struct EnvironmentBands {
    float3 flat, first, second;
};

EnvironmentBands environmentBands(ShadeConstants shade, float3 d) {
    EnvironmentBands bands;
    bands.flat = 0.28209479 * shade.environment[0].rgb;
    bands.first = 0.48860251 * (d.y * shade.environment[1].rgb + d.z * shade.environment[2].rgb +
                                d.x * shade.environment[3].rgb);
    bands.second =
        1.0925484 * (d.x * d.y * shade.environment[4].rgb + d.y * d.z * shade.environment[5].rgb +
                     d.z * d.x * shade.environment[7].rgb) +
        0.31539157 * (3.0 * d.z * d.z - 1.0) * shade.environment[6].rgb +
        0.54627422 * (d.x * d.x - d.y * d.y) * shade.environment[8].rgb;
    return bands;
}

// Radiance from a direction.
float3 environmentFrom(ShadeConstants shade, float3 d) {
    const EnvironmentBands bands = environmentBands(shade, d);
    return max(bands.flat + bands.first + bands.second, 0.0);
}

// Mean radiance around a normal, weighted by the cosine (Ramamoorthi and Hanrahan 2001): the bands are scaled by 1, 2/3
// and 1/4.
float3 environmentOnSkin(ShadeConstants shade, float3 n) {
    const EnvironmentBands bands = environmentBands(shade, n);
    return max(bands.flat + bands.first * (2.0 / 3.0) + bands.second * 0.25, 0.0);
}
#endif
