// SPDX-License-Identifier: GPL-3.0-or-later
// Weighted blended transparency (McGuire and Bavoil 2013): sums of light times weight, and the product of what each hair
// lets through. The weight halves with every few millimetres behind where hair begins, as hair in front hides it.
#include "shaders/render/across_ribbon.hlsli"
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { ViewConstants gView; };

struct Input {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float2 coverage : COVERAGE;  // x: of the ribbon by the hair, y: RibbonCorner::depth
    float2 place : PLACE;
    nointerpolation uint2 pieces : PIECES;
};

struct Output {
    float4 sum : SV_Target0;
    float4 rest : SV_Target1;
};

static const float kHalvings = 26.0;  // over the depth of the hair; half floats reach no farther

Output main(Input i) {
    const float alpha = saturate(i.coverage.x);
    const float behind = saturate((i.coverage.y - gView.hairBegins) / max(gView.hairDepth, 1e-6));
    const float weight = alpha * exp2(kHalvings * (0.45 - behind));
    Output o;
    o.sum = float4(lightOn(gView, i.colour, i.pieces, i.place) * weight, weight);
    o.rest = alpha.xxxx;
    return o;
}
