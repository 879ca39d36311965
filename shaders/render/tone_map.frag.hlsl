// SPDX-License-Identifier: GPL-3.0-or-later
// From the sum of frames to what a screen shows.
#include "shaders/shared/render_types.h"
#include "shaders/render/tone_map.hlsli"

cbuffer Constants : register(b0) { ToneConstants gTone; };
StructuredBuffer<float4> gSum : register(t0);

float4 main(float4 position : SV_Position) : SV_Target0 {
    const float4 average = gSum[uint(position.y) * uint(gTone.width) + uint(position.x)] * gTone.frameShare;
    const float3 shown = toneCurve(average.rgb * gTone.exposure);
    return float4(gTone.encodesSrgb > 0 ? encodeSrgb(shown) : shown, saturate(average.a));
}
