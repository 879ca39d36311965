// SPDX-License-Identifier: GPL-3.0-or-later
// Partial coverage as a random set of samples (Enderton et al. 2010, stochastic transparency): the right amount on
// average whatever lies behind and in whatever order; averaging frames with other numbers removes the noise.
#include "shaders/curve.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };

struct Input {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float coverage : COVERAGE;
    nointerpolation uint seed : SEED;
};

struct Output {
    float4 colour : SV_Target0;
    uint mask : SV_Coverage;
};

Output main(Input i) {
    const uint samples = gView.sampling.x;
    const uint2 pixel = uint2(i.position.xy);
    const uint key = hashUint(i.seed * 0x9e3779b9u + hashUint(pixel.x + (pixel.y << 16u) + gView.sampling.y * 0x85ebca6bu));
    const uint count = min(uint(i.coverage * float(samples) + hashUnit(key)), samples);
    if (count == 0) discard;
    // A run of count samples, rotated by a random amount.
    const uint run = (1u << count) - 1u;
    const uint turn = hashUint(key + 1u) % samples;
    Output o;
    o.colour = float4(i.colour, 1);
    o.mask = ((run << turn) | (run >> (samples - turn))) & ((1u << samples) - 1u);
    return o;
}
