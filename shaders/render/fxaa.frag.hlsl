// SPDX-License-Identifier: GPL-3.0-or-later
// Fast approximate anti-aliasing, written after Lottes 2011 ("FXAA"): where the picture has an edge, follow it both ways
// to its ends and take the colour from beside, by as much as the edge would cover of this pixel.
#include "shaders/shared/render_types.h"
#include "shaders/render/tone_map.hlsli"

cbuffer Constants : register(b0) { FilterConstants gFilter; };
Texture2D<float4> gPicture : register(t0);  // sRGB values
SamplerState gLinear : register(s0);

static const float kMinContrast = 0.0312;   // below it is noise
static const float kContrastShare = 0.125;    // of the brightest neighbour
static const float kSubpixel = 0.75;          // how much single pixels are smoothed

float lumaAt(float2 uv) { return dot(gPicture.SampleLevel(gLinear, uv, 0).rgb, float3(0.299, 0.587, 0.114)); }

// Pixels that a step along the edge advances; the first ones are exact, later ones guess.
float stepSize(uint i, bool longSearch) {
    if (longSearch) return i < 5u ? 1.0 : (i == 5u ? 1.5 : (i < 10u ? 2.0 : (i == 10u ? 4.0 : 8.0)));
    return i == 0u ? 1.0 : (i == 1u ? 1.5 : (i == 2u ? 2.0 : (i == 3u ? 4.0 : 12.0)));
}

float4 shown(float2 uv) {
    const float4 colour = gPicture.SampleLevel(gLinear, uv, 0);
    return float4(gFilter.keepsSrgb > 0 ? colour.rgb : decodeSrgb(colour.rgb), colour.a);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    const float2 texel = float2(gFilter.texelWidth, gFilter.texelHeight);
    const float2 uv = position.xy * texel;
    const float m = lumaAt(uv);
    const float n = lumaAt(uv - float2(0, texel.y));
    const float s = lumaAt(uv + float2(0, texel.y));
    const float w = lumaAt(uv - float2(texel.x, 0));
    const float e = lumaAt(uv + float2(texel.x, 0));
    const float maximum = max(m, max(max(n, s), max(w, e)));
    const float contrast = maximum - min(m, min(min(n, s), min(w, e)));
    if (contrast < max(kMinContrast, kContrastShare * maximum)) return shown(uv);
    const float nw = lumaAt(uv - texel);
    const float se = lumaAt(uv + texel);
    const float ne = lumaAt(uv + float2(texel.x, -texel.y));
    const float sw = lumaAt(uv + float2(-texel.x, texel.y));

    // Single pixels that stand out from all around.
    const float around = (2.0 * (n + s + w + e) + nw + ne + sw + se) / 12.0;
    const float outstanding = smoothstep(0.0, 1.0, saturate(abs(around - m) / contrast));
    const float single = outstanding * outstanding * kSubpixel;

    const float level = 2.0 * abs(n + s - 2.0 * m) + abs(nw + sw - 2.0 * w) + abs(ne + se - 2.0 * e);
    const float upright = 2.0 * abs(w + e - 2.0 * m) + abs(nw + ne - 2.0 * n) + abs(sw + se - 2.0 * s);
    const bool horizontal = level >= upright;

    // The side of the pixel that the edge runs along.
    const float before = horizontal ? n : w;
    const float after = horizontal ? s : e;
    const bool towardsBefore = abs(before - m) >= abs(after - m);
    const float sideLuma = towardsBefore ? before : after;
    const float2 across = (horizontal ? float2(0, texel.y) : float2(texel.x, 0)) * (towardsBefore ? -1.0 : 1.0);
    const float2 along = horizontal ? float2(texel.x, 0) : float2(0, texel.y);
    const float edgeLuma = 0.5 * (m + sideLuma);
    const float gradient = 0.25 * abs(sideLuma - m);

    // To both ends, where the mean of the two rows leaves that of the edge.
    const float2 onEdge = uv + 0.5 * across;
    const bool longSearch = gFilter.longSearch > 0;
    const uint steps = longSearch ? 12u : 5u;
    float2 back = 0;
    float2 front = 0;
    float backLuma = 0;
    float frontLuma = 0;
    bool backDone = false;
    bool frontDone = false;
    for (uint i = 0; i < steps && !(backDone && frontDone); ++i) {
        const float2 advance = along * stepSize(i, longSearch);
        if (!backDone) {
            back += advance;
            backLuma = lumaAt(onEdge - back) - edgeLuma;
            backDone = abs(backLuma) >= gradient;
        }
        if (!frontDone) {
            front += advance;
            frontLuma = lumaAt(onEdge + front) - edgeLuma;
            frontDone = abs(frontLuma) >= gradient;
        }
    }
    const float backLength = length(back / texel);
    const float frontLength = length(front / texel);
    const float nearest = min(backLength, frontLength);
    const float nearestLuma = backLength < frontLength ? backLuma : frontLuma;
    // Only where the edge ends on the other side of its mean does it cover part of this pixel.
    const bool covers = (nearestLuma < 0) != (m - edgeLuma < 0);
    const float edge = covers ? 0.5 - nearest / max(backLength + frontLength, 1e-3) : 0.0;
    return shown(uv + across * max(edge, single));
}
