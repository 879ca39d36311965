// SPDX-License-Identifier: MIT
// What the kernels of follow hairs share with the program.
#ifndef HAIRLOOM_FOLLOW_TYPES_H
#define HAIRLOOM_FOLLOW_TYPES_H
#include "types.h"

#ifdef __cplusplus
#include <cstddef>
namespace hairloom::shaders {
#endif

struct FollowConstants {
    uint guides;
    uint hairs;
    uint points;       ///< per hair
    float wispSpread;  ///< σ of Eq. 22 at the tip, s/m
    uint hasVelocities;
    float wispLimit;  ///< greatest ξ of Eq. 22
    uint unused0, unused1;
};

/// The root plane of a guide at rest.
struct FollowPlane {
    float4 x, y, normal;
};

/// A hair's share of each row that it is summed from; runtime::FollowView has the formula.
struct FollowBinding {
    uint4 guides;    ///< w unused
    float4 weights;  ///< of the three guides' points; w: of the wisp's centre
    float4 roots;    ///< of the three guides' roots, less `weights`; w unused
    float4 shift;    ///< along the axes of the own guide's root plane; w unused
    float4 wisp;     ///< x, y: position in the wisp's cross-section; z, w unused
};

#ifdef __cplusplus
static_assert(sizeof(FollowConstants) == 32 && sizeof(FollowPlane) == 48 && sizeof(FollowBinding) == 80);
static_assert(offsetof(FollowBinding, shift) == 48);
}  // namespace hairloom::shaders
#endif
#endif
