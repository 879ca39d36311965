// SPDX-License-Identifier: MIT
// What the kernels that lead drawn hair out of a body are told.
#ifndef HAIRLOOM_PUSH_TYPES_H
#define HAIRLOOM_PUSH_TYPES_H
#include "types.h"

#ifdef __cplusplus
namespace hairloom::shaders {
#endif

/// Metres from the body at which hair stays that was authored no closer: skin bulges between distances.
#define HAIRLOOM_PUSH_KEPT 0.0005
/// Metres of what a field that is interpolated is wrong at most: hair that rests is not moved.
#define HAIRLOOM_PUSH_SLACK 1e-5
/// Times that a hair is looked at, and a point that is deep.
#define HAIRLOOM_PUSH_ROUNDS 6
#define HAIRLOOM_PUSH_POINT_ROUNDS 3
/// How much farther from both ends together a place of a curve is than these from each other, of the lengths
/// beside.
#define HAIRLOOM_PUSH_BOW 0.140625
#define HAIRLOOM_PUSH_GROUP 64

struct PushConstants {
    uint hairs;
    uint points;
    uint unused0, unused1;
};

#ifdef __cplusplus
}  // namespace hairloom::shaders
#endif
#endif
