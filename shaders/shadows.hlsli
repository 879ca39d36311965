// SPDX-License-Identifier: GPL-3.0-or-later
// What stands between a point and a light: the head (a depth map) and fibres (a deep opacity map).
#include "shaders/opacity.hlsli"
#include "shaders/shared/render_types.h"

Texture2D<float> gHeadDepth : register(t8);
Texture2D<float> gFirstHair : register(t9);
Texture2D<float4> gOpacity : register(t10);

float fibresInLayers(float4 layers, float4 ends, float behind) {
    const float4 begins = float4(0, ends.xyz);
    const float4 part = saturate((behind - begins) / (ends - begins));
    return dot(layers, part) / OPACITY_UNIT;
}

struct Occlusion {
    float fibres;      // crossed on the way to the light
    float allFibres;   // from the hair's lit side to its other, or to the head
    float visibility;  // 0 behind the head … 1
};

// bias: metres towards the light, so that a surface does not shadow itself.
Occlusion occlusion(LightConstants light, float4 ends, float3 position_ws, float hairBias, float headBias) {
    Occlusion result;
    result.fibres = 0;
    result.allFibres = 0;
    result.visibility = 1;
    const float4 clip = mul(light.clipFromWorld, float4(position_ws, 1));
    const float2 uv = float2(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
    if (light.range.y == 0 || any(uv < 0.0) || any(uv > 1.0) || clip.z > 1.0) return result;
    uint width, height;
    gOpacity.GetDimensions(width, height);
    const float2 size = float2(float(height), float(height));
    const int tile = int(light.tile.x * float(width) + 0.5);
    const float2 texel = uv * size - 0.5;
    const int2 base = int2(floor(texel));
    const float2 f = texel - float2(base);
    float fibres = 0;
    float visible = 0;
    float all = 0;
    // A quadratic B-spline over 3 x 3 texels of finished comparisons.
    const float3 wx = float3(0.5 * (1 - f.x) * (1 - f.x), 0.5 + f.x * (1 - f.x), 0.5 * f.x * f.x);
    const float3 wy = float3(0.5 * (1 - f.y) * (1 - f.y), 0.5 + f.y * (1 - f.y), 0.5 * f.y * f.y);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            const int2 at = clamp(base + int2(x, y), int2(0, 0), int2(int(height) - 1, int(height) - 1));
            const int3 where = int3(at.x + tile, at.y, 0);
            const float w = wx[x] * wy[y];
            const float firstHair = gFirstHair.Load(where);
            const float head = gHeadDepth.Load(where);
            const float4 layers = gOpacity.Load(where);
            fibres += w * fibresInLayers(layers, ends, (clip.z - firstHair) * light.range.x - hairBias);
            all += w * fibresInLayers(layers, ends, (head - firstHair) * light.range.x);
            visible += w * ((clip.z - head) * light.range.x < headBias ? 1.0 : 0.0);
        }
    }
    result.fibres = fibres;
    result.allFibres = max(all, fibres);
    result.visibility = visible;
    return result;
}
