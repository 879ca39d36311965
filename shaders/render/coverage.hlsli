// SPDX-License-Identifier: GPL-3.0-or-later
// Partial coverage as a set of samples. A random set (Enderton et al. 2010, stochastic transparency) is the right amount
// on average whatever lies behind and in whatever order, and averaging frames with other numbers removes the noise. A
// set that depends on coverage alone is alpha-to-coverage: no noise, but hairs behind each other hide as one.
#ifndef HAIRLOOM_COVERAGE_HLSLI
#define HAIRLOOM_COVERAGE_HLSLI
#include "shaders/render/curve.hlsli"

// The samples of a pixel that a hair with this share of it takes; bit s is sample s.
uint sampleMask(ViewConstants view, float coverage, uint2 pixel, uint strand) {
    const uint samples = view.samples;
    const uint key = hashUint(strand * 0x9e3779b9u + hashUint(pixel.x + (pixel.y << 16u) + view.frame * 0x85ebca6bu));
    const bool fixedSet = view.transparency == HAIRLOOM_TRANSPARENCY_ALPHA_TO_COVERAGE;
    // Interleaved gradient noise (Jimenez 2014) rounds a fixed set up or down by place.
    const float ordered = frac(52.9829189 * frac(dot(float2(pixel), float2(0.06711056, 0.00583715))));
    const float chance = fixedSet ? ordered : hashUnit(key);
    const uint count = min(uint(coverage * float(samples) + chance), samples);
    // A run of count samples, rotated by a random amount.
    const uint run = (1u << count) - 1u;
    const uint turn = fixedSet ? 0u : hashUint(key + 1u) % samples;
    return ((run << turn) | (run >> (samples - turn))) & ((1u << samples) - 1u);
}
#endif
