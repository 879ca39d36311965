// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The space that a dab reaches: all points within a radius of a piece of line.

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace hairloom::editing {

/// A capsule; a sphere where `halfLength` is 0. Metres, scalp rest space.
struct BrushVolume {
    Vec3f centre = Vec3f::Zero();
    Vec3f axis = Vec3f::UnitZ();  ///< unit length
    float halfLength = 0;
    float radius = 0;

    /// From the point to the nearest of the axis.
    Vec3f fromAxis(const Vec3f& point) const {
        const Vec3f away = point - centre;
        return away - axis * std::clamp(away.dot(axis), -halfLength, halfLength);
    }
    float squaredDistance(const Vec3f& point) const { return fromAxis(point).squaredNorm(); }

    /// False only where no point of the box is inside; true may be wrong near the box's corners.
    bool mayTouch(const Vec3f& low, const Vec3f& high) const {
        if (halfLength <= 0) {
            const Vec3f nearest = centre.cwiseMax(low).cwiseMin(high);
            return (nearest - centre).squaredNorm() <= radius * radius;
        }
        // The piece of line against the box grown by the radius, one pair of faces after the other.
        float from = -halfLength;
        float to = halfLength;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const float a = low[i] - radius - centre[i];
            const float b = high[i] + radius - centre[i];
            constexpr float kParallel = 1e-12f;
            if (std::abs(axis[i]) < kParallel) {
                if (a > 0 || b < 0) return false;
                continue;
            }
            const float s = a / axis[i];
            const float t = b / axis[i];
            from = std::max(from, std::min(s, t));
            to = std::min(to, std::max(s, t));
        }
        return from <= to;
    }
};

}  // namespace hairloom::editing
