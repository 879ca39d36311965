// SPDX-License-Identifier: GPL-3.0-or-later
// Partial coverage as a set of samples. A random set (Enderton et al. 2010, stochastic transparency) is the right amount
// on average whatever lies behind and in whatever order, and averaging frames with other numbers removes the noise.
#ifndef HAIRLOOM_COVERAGE_HLSLI
#define HAIRLOOM_COVERAGE_HLSLI
#include "shaders/render/curve.hlsli"

// The samples of a pixel that a hair with this share of it takes; bit s is sample s.
uint sampleMask(ViewConstants view, float coverage, uint2 pixel, uint strand) {
    const uint samples = view.samples;
    const uint key = hashUint(strand * 0x9e3779b9u + hashUint(pixel.x + (pixel.y << 16u) + view.frame * 0x85ebca6bu));
    const uint count = min(uint(coverage * float(samples) + hashUnit(key)), samples);
    // A run of count samples, rotated by a random amount.
    const uint run = (1u << count) - 1u;
    const uint turn = hashUint(key + 1u) % samples;
    return ((run << turn) | (run >> (samples - turn))) & ((1u << samples) - 1u);
}
#endif
