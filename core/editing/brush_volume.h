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
};

/// Whether boxes come near a volume. What a hundred thousand boxes have in common is worked out once.
class BoxTest {
  public:
    explicit BoxTest(const BrushVolume& volume) : volume_(volume) {
        for (Eigen::Index i = 0; i < 3; ++i) {
            constexpr float kParallel = 1e-12f;
            const float along = volume.axis[i];
            perMetre_[i] = 1 / (std::abs(along) < kParallel ? std::copysign(kParallel, along) : along);
        }
    }
    /// False only where no point of the box is inside; true may be wrong near the box's corners.
    bool operator()(const Vec3f& low, const Vec3f& high) const {
        return volume_.halfLength > 0 ? touchesCapsule(low, high) : touchesSphere(low, high);
    }

  private:
    bool touchesSphere(const Vec3f& low, const Vec3f& high) const {
        const Vec3f nearest = volume_.centre.cwiseMax(low).cwiseMin(high);
        return (nearest - volume_.centre).squaredNorm() <= volume_.radius * volume_.radius;
    }
    /// The piece of line against the box grown by the radius, one pair of faces after the other. Without
    /// branches: boxes come in no order.
    bool touchesCapsule(const Vec3f& low, const Vec3f& high) const {
        float from = -volume_.halfLength;
        float to = volume_.halfLength;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const float s = (low[i] - volume_.radius - volume_.centre[i]) * perMetre_[i];
            const float t = (high[i] + volume_.radius - volume_.centre[i]) * perMetre_[i];
            from = std::max(from, std::min(s, t));
            to = std::min(to, std::max(s, t));
        }
        return from <= to;
    }

    BrushVolume volume_;
    Vec3f perMetre_;  ///< one by the axis
};

}  // namespace hairloom::editing
