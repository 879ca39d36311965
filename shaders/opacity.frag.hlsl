// SPDX-License-Identifier: GPL-3.0-or-later
// Deep opacity maps (Yuksel and Keyser 2008): adds each hair's coverage to the layer that its distance behind the
// first hair falls into. Layers hold what lies in them alone; RGBA16_UNORM adds without rounding.
#include "shaders/shared/render_types.h"
#include "shaders/opacity.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
Texture2D<float> gFirstHair : register(t2);

struct Input {
    float4 position : SV_Position;
    float coverage : COVERAGE;
};

float4 main(Input i) : SV_Target0 {
    const float start = gFirstHair.Load(int3(int2(i.position.xy), 0));
    const float behind = (i.position.z - start) * gView.range.x;
    const float amount = saturate(i.coverage) * OPACITY_UNIT;
    return behind < gView.layers.x   ? float4(amount, 0, 0, 0)
           : behind < gView.layers.y ? float4(0, amount, 0, 0)
           : behind < gView.layers.z ? float4(0, 0, amount, 0)
                                     : float4(0, 0, 0, amount);
}
