// SPDX-License-Identifier: GPL-3.0-or-later
// Partial coverage as a set of samples. A random set (Enderton et al. 2010, stochastic transparency) is the right amount
// on average whatever lies behind and in whatever order, and averaging frames with other numbers removes the noise. A
// set that depends on coverage alone is alpha-to-coverage: no noise, but hairs behind each other hide as one.
#include "shaders/curve.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };

struct Input {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float2 coverage : COVERAGE;  // x: of the ribbon by the hair, y: metres in front of the eye
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
    const bool fixedSet = gView.sampling.z == HAIRLOOM_TRANSPARENCY_ALPHA_TO_COVERAGE;
    // Interleaved gradient noise (Jimenez 2014) rounds a fixed set up or down by place.
    const float ordered = frac(52.9829189 * frac(dot(float2(pixel), float2(0.06711056, 0.00583715))));
    const float chance = fixedSet ? ordered : hashUnit(key);
    const uint count = min(uint(i.coverage.x * float(samples) + chance), samples);
    if (count == 0) discard;
    // A run of count samples, rotated by a random amount.
    const uint run = (1u << count) - 1u;
    const uint turn = fixedSet ? 0u : hashUint(key + 1u) % samples;
    Output o;
    o.colour = float4(i.colour, 1);
    o.mask = ((run << turn) | (run >> (samples - turn))) & ((1u << samples) - 1u);
    return o;
}
