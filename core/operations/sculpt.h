// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What brush strokes did to a strand, kept so that it follows when the strand below changes: per point what
// was added to the segment that ends there, in a frame that is carried along the strand, as a share of the
// segment's length. A strand that is turned or made longer below is so with what was sculpted.

#include <span>

#include "core/base/math.h"

namespace hairloom {

/// `input` has n ≥ 2 points, metres; `offsets` n shares, the first unused; `output` gets n points. Points
/// before the first offset that is not 0 keep their bits. `weight` 0 … 1 turns and lengthens segments by that
/// share of what the offsets do.
void applySculpt(std::span<const Vec3f> input, std::span<const Vec3f> offsets, float weight,
                 std::span<Vec3f> output);

/// The offsets that lead from `input` to `wanted`, which has as many points and the same root, but for
/// rounding. All 0 where they are equal.
void measureSculpt(std::span<const Vec3f> input, std::span<const Vec3f> wanted, std::span<Vec3f> offsets);

}  // namespace hairloom
