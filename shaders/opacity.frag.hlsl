// SPDX-License-Identifier: GPL-3.0-or-later
// Adds each hair's coverage to the layer that it falls into. Layers hold what lies in them alone; RGBA16_UNORM adds
// without rounding. Deep opacity maps (Yuksel and Keyser 2008) count depth from the first hair of each texel and keep
// that depth in alpha, which blends by the maximum; opacity shadow maps (Kim and Neumann 2001) count it from where hair
// begins and have a fourth layer in its place.
#include "shaders/opacity.hlsli"
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { ViewConstants gView; };
Texture2D<float> gFirstHair : register(t2);

struct Input {
    float4 position : SV_Position;
    float coverage : COVERAGE;
};

float4 main(Input i) : SV_Target0 {
    const float amount = saturate(i.coverage) * OPACITY_UNIT;
    const float depth = metresBehindNear(gView.range, i.position.z);
    if (gView.sampling.w == HAIRLOOM_SHADOWS_OPACITY_MAPS) {
        const float behind = depth - gView.range.w;
        return behind < gView.layers.x   ? float4(amount, 0, 0, 0)
               : behind < gView.layers.y ? float4(0, amount, 0, 0)
               : behind < gView.layers.z ? float4(0, 0, amount, 0)
                                         : float4(0, 0, 0, amount);
    }
    const float first = metresBehindNear(gView.range, gFirstHair.Load(int3(int2(i.position.xy), 0)));
    const float behind = depth - first;
    const float near = 1.0 - saturate(first / gView.range.x);
    return behind < gView.layers.x   ? float4(amount, 0, 0, near)
           : behind < gView.layers.y ? float4(0, amount, 0, near)
                                     : float4(0, 0, amount, near);
}
