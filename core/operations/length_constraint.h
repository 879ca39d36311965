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

/// Gives segments these lengths again, root to tip, after points 1 … n−1 were moved: each segment keeps the
/// direction that the move gave it. Where points were drawn farther apart than hair reaches, segments behind
/// lead on to where they were wanted, and never back: no segment turns round that the move
/// itself did not turn. With `keepFirst` the first segment is left as it is.
void restoreLengths(std::span<Vec3f> points, std::span<const float> lengths, bool keepFirst = false);

/// The same by turning segments alone: the rest of the strand moves along, and nothing is made up for. Fit
/// for bends whose shape matters more than their place (curls, noise).
void restoreLengthsByDirection(std::span<Vec3f> points, std::span<const float> lengths);

/// Points nearer to the skin than `clearance` (metres) are moved out, and what hangs on them is carried
/// along: segments keep their directions, as far as the skin lets them, and turn by no more than 28 degrees
/// from the last, or than they did. Near the root the clearance grows with half the arc length. The strand is
/// unchanged where none is too near, and before the point `first` (≥ 1) in any case. True when it moved.
bool keepOutside(std::span<Vec3f> points, std::span<const float> lengths, const SkinQuery& skin,
                 float clearance, std::size_t first = 1);

/// Cosine of the turn at each point, from the segment that ends there to the one that begins; 1 at root and
/// tip and where a segment points nowhere. `turns` gets points.size() values.
void measureTurns(std::span<const Vec3f> points, std::vector<float>& turns);

/// The unit vector `wanted` as far as a segment may turn to it from the unit vector `last`: by 28 degrees, or
/// by an angle of the cosine `turn` where that is more.
Vec3f turnedAsMay(const Vec3f& last, const Vec3f& wanted, float turn);

/// Ends an edit that moved the points from `first` (≥ 1) on: out of the skin as keepOutside() leaves it, or
/// anyhow where `skin` is null, and turning at no point by more than 28 degrees or than `turns` has for it
/// (cosines, as measureTurns() gives them). What is turned back carries the rest of the strand along, and
/// what the skin turns bends before it is met. Only where the points before `first` leave no way, the skin
/// may turn hair further.
void settle(std::span<Vec3f> points, std::span<const float> lengths, std::span<const float> turns,
            const SkinQuery* skin, float clearance, std::size_t first = 1);

/// The end of a segment of `length` from `from` that points as nearly along the unit vector `direction` as
/// lets it keep `clearance` from the skin.
Vec3f placeOutside(const SkinQuery& skin, const Vec3f& from, const Vec3f& direction, float length,
                   float clearance);

}  // namespace hairloom
