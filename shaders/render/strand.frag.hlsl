// SPDX-License-Identifier: GPL-3.0-or-later
// The light of a hair into the samples that its coverage takes.
#include "shaders/render/across_ribbon.hlsli"
#include "shaders/render/coverage.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };

struct Input {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float2 coverage : COVERAGE;  // x: of the ribbon by the hair, y: metres in front of the eye
    nointerpolation uint seed : SEED;
    float2 place : PLACE;
    nointerpolation uint2 pieces : PIECES;
};

struct Output {
    float4 colour : SV_Target0;
    uint mask : SV_Coverage;
};

Output main(Input i) {
    Output o;
    o.colour = float4(lightOn(gView, i.colour, i.pieces, i.place), 1);
    o.mask = sampleMask(gView, i.coverage.x, uint2(i.position.xy), i.seed);
    if (o.mask == 0u) discard;
    return o;
}
