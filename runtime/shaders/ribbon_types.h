// SPDX-License-Identifier: MIT
// What the shaders of ribbons share with the program; hairloom/gpu.h has both for C.
#ifndef HAIRLOOM_RIBBON_TYPES_H
#define HAIRLOOM_RIBBON_TYPES_H
#include "types.h"

#ifdef __cplusplus
namespace hairloom::shaders {
#endif

struct RibbonView {
    float4x4 clipFromWorld;
    float4 eye;       ///< where hairs are measured from; w unused
    float4 toLight;   ///< of unit length; w: exponent of the highlight
    float4 light;     ///< linear; w: share that comes from everywhere
    float4 specular;  ///< of the highlight, linear; w: how much wider hairs are, 0: as they are
    float pixelSize;  ///< metres that a pixel covers at a metre's distance
    float minPixels;  ///< narrower hairs are as wide and let as much light through
    uint points;      ///< per hair
    uint hairs;
};

/// What a hair looks like.
struct RibbonLook {
    float4 colour;  ///< linear; w: its random number, 0 to 1
    float4 radii;   ///< metres: x at the root, y at the tip
};

#ifdef __cplusplus
static_assert(sizeof(RibbonView) == 144 && sizeof(RibbonLook) == 32);
}  // namespace hairloom::shaders
#endif
#endif
