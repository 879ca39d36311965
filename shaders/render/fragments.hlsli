// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest fragments of hair of each pixel, in their order.
#ifndef HAIRLOOM_FRAGMENTS_HLSLI
#define HAIRLOOM_FRAGMENTS_HLSLI
#include "shaders/render/raster.hlsli"

static const uint kNoFragment = 0x3f800000u;  // the depth 1
static const uint kMostSteps = 9u * HAIRLOOM_HALVING_STEPS;  // a pixel that lets less through lets nothing through

uint packCover(float cover, uint fragment) { return uint(cover * 65535.0 + 0.5) << (16u * (fragment & 1u)); }

float unpackCover(uint word, uint fragment) {
    return float((word >> (16u * (fragment & 1u))) & 0xffffu) * (1.0 / 65535.0);
}

// By how often cover halves what lies behind it, in steps.
uint halvingSteps(float cover) { return uint(-log2(max(1.0 - cover, 1e-4)) * float(HAIRLOOM_HALVING_STEPS) + 0.5); }

// Where all hair in a pixel is summed up.
uint stepsOf(uint pixel) { return pixel * HAIRLOOM_COVER_WORDS + HAIRLOOM_COVER_WORDS - 1u; }

float letThrough(uint steps) { return steps < kMostSteps ? exp2(-float(steps) / float(HAIRLOOM_HALVING_STEPS)) : 0.0; }
#endif
