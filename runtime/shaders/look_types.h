// SPDX-License-Identifier: MIT
// What the look of hair from place to place is told to shaders by.
#ifndef HAIRLOOM_LOOK_TYPES_H
#define HAIRLOOM_LOOK_TYPES_H
#include "types.h"

#ifdef __cplusplus
namespace hairloom::shaders {
#endif

// Colours (linear RGB) or absorption (RGB per fibre radius) from place to place.
struct LookConstants {
    float4 root;
    float4 tip;
    float4 streakRoot;
    float4 streakTip;
    float4 dye;
    float4 emissionRoot;  // linear RGB radiance
    float4 emissionTip;
    float gradientStart;  // along a strand, where it begins
    float gradientScale;  // one by its length
    float dyeStart;
    float dyeScale;
    uint absorbs;    // 1 for absorption, 0 for colours
    float ownScale;  // what the logarithm of a strand's own colour is multiplied with
    float spread;    // random, of absorption
    float streakPigment;
    float regrowthStart;  // metres from the root
    float regrowthScale;
    float unused0, unused1;
};

#ifdef __cplusplus
static_assert(sizeof(LookConstants) == 160);
}  // namespace hairloom::shaders
#endif
#endif
