// SPDX-License-Identifier: MIT
#pragma once
// How much room a look at a body leaves around a place.

#include "hairloom/body_field.h"

namespace hairloom::runtime {

/// Metres that a body is away at least from a place at `distance` of it: what is interpolated, and posed, may
/// be closer than it seems; where cells are small, by less. Below 0 where it is not away.
inline float surelyFree(float distance, float cell) {
    constexpr float kSure = 0.9f, kUnsure = 0.2f, kUnsureFine = 0.05f;
    return kSure * distance - (distance < BodyField::kFineReach ? kUnsureFine : kUnsure) * cell;
}

}  // namespace hairloom::runtime
