// SPDX-License-Identifier: GPL-3.0-or-later
// Marks with soft edges. Colours are as shown; a target that encodes sRGB itself gets them decoded.
#include "shaders/shared/render_types.h"
#include "shaders/render/tone_map.hlsli"

cbuffer Constants : register(b0) { OverlayConstants gOverlay; };

struct Input {
    float4 position : SV_Position;
    float4 colour : COLOR;
    noperspective float2 offset : OFFSET;
    nointerpolation float halfLength : HALFSIZE;
};

float4 main(Input i) : SV_Target0 {
    const float3 colour = gOverlay.keepsSrgb > 0 ? i.colour.rgb : decodeSrgb(i.colour.rgb);
    if (gOverlay.shape == 2u) return float4(colour, i.colour.a);
    // Distance from the point, or from the line's nearest point.
    const float2 d = float2(max(abs(i.offset.x) - i.halfLength, 0.0), i.offset.y);
    const float radius = gOverlay.markRadius;
    const float edge = saturate(radius + 0.5 - length(d)) - saturate(0.5 - radius - length(d));
    if (edge <= 0) discard;
    return float4(colour, i.colour.a * edge);
}
