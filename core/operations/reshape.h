// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands of another length with the same number of points. Roots stay.

#include <span>

#include "core/base/math.h"

namespace hairloom {

/// Position at a share 0 … 1 of the points, of which there are two at least, from the root.
Vec3f pointAlong(std::span<const Vec3f> points, float t);

/// Scales about the root; a strand without length grows along +Y. `length` > 0, metres.
void scaleToLength(std::span<Vec3f> points, float length);

/// Follows the strand up to `length`, or on from its tip in the last direction, with evenly spaced points.
/// The result has exactly this length, measured over its segments.
void cutOrExtend(std::span<Vec3f> points, float length);

}  // namespace hairloom
