// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How much wider or thinner hair was painted, point by point.

#include <algorithm>
#include <cmath>
#include <span>

#include "core/groom/groom.h"

namespace hairloom {

namespace attribute {
/// Per point: float from -1 to kMaxWidthChange, as it was painted: by how much the fibre is wider than its
/// radius or its material says, as a share of that. 0, as of hair that comes without, leaves it as it is, and
/// 1 makes it twice as wide.
inline constexpr std::string_view kWidthChange = "width_change";
}  // namespace attribute

inline constexpr float kMaxWidthChange = 9;

/// One a point; empty where nothing was painted.
inline std::span<const float> widthChanges(const Groom& groom) {
    const auto changes = groom.pointAttributes.view<float>(attribute::kWidthChange);
    return changes.size() == groom.pointCount() ? changes : std::span<const float>();
}

/// A radius (metres, ≥ 0) with a change of it; changes out of range count as the nearest that is in it, and
/// what is no number as none. No hair becomes a metre thick by it.
inline float widened(float radius, float change) {
    constexpr float kWidest = 0.5f;  // metres
    if (std::isnan(change)) return radius;
    return std::min(radius * (1 + std::clamp(change, -1.0f, kMaxWidthChange)), std::max(radius, kWidest));
}

}  // namespace hairloom
