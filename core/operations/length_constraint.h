// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The constraint that operations and brushes share: segments keep their lengths, roots stay, hair stays out
// of the head.

#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/operations/skin.h"

namespace hairloom {

/// Length of each segment, metres; `lengths` gets points.size() − 1 values.
void measureSegments(std::span<const Vec3f> points, std::vector<float>& lengths);

/// Moves points 1 … n−1 so that segments have these lengths again, root to tip, each as near to where it was
/// as its predecessor allows. With `keepFirst` the first segment is left as it is.
void restoreLengths(std::span<Vec3f> points, std::span<const float> lengths, bool keepFirst = false);

/// The same by turning segments alone: each keeps its direction and the rest of the strand moves along. Fit
/// for bends whose shape matters more than their place (curls, noise).
void restoreLengthsByDirection(std::span<Vec3f> points, std::span<const float> lengths);

/// Points nearer to the skin than `clearance` (metres) are moved out as restoreLengths() would; near the root
/// the clearance grows with half the arc length. The strand is unchanged where none is too near, and before
/// the point `first` (≥ 1) in any case. True when it moved.
bool keepOutside(std::span<Vec3f> points, std::span<const float> lengths, const SkinQuery& skin,
                 float clearance, std::size_t first = 1);

/// The end of a segment of `length` from `from` that points as nearly along the unit vector `direction` as
/// lets it keep `clearance` from the skin.
Vec3f placeOutside(const SkinQuery& skin, const Vec3f& from, const Vec3f& direction, float length,
                   float clearance);

}  // namespace hairloom
