// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light in hair, as simple as tells strands, cards and shells apart by the same rule: light from around that
// hair nearby takes away, one lamp with its shadow through the hair, Kajiya-Kay's reflection.

#include <array>

#include "core/cards/hair.h"

namespace hairloom::cards {

/// On a grid over the hair, by how much area of fibres a ray crosses.
class HairLight {
  public:
    /// Errors: stopped.
    static Result<HairLight> make(const Hair& hair, Cancel cancel);

    /// Share of the light from around that reaches a place, 0 … 1.
    float open(const Vec3f& place_ws) const { return at(open_, place_ws); }
    /// Share of the lamp's light that does.
    float lit(const Vec3f& place_ws) const { return at(lit_, place_ws); }
    /// Area of fibres, as seen from a side, in a cubic metre; 1/m.
    float density(const Vec3f& place_ws) const { return at(density_, place_ws); }

    const Vec3f& low() const { return low_; }
    const std::array<int, 3>& cells() const { return size_; }
    float cell() const { return cell_; }  ///< metres

  private:
    float at(const std::vector<float>& values, const Vec3f& place_ws) const;
    std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_[0]) +
               static_cast<std::size_t>(x);
    }
    float depthAlong(const std::vector<float>& blocked, const Vec3f& from, const Vec3f& step) const;

    Vec3f low_ = Vec3f::Zero();
    float cell_ = 1;
    std::array<int, 3> size_{1, 1, 1};
    std::vector<float> density_, open_, lit_;
};

/// Towards the lamp: over the head's left shoulder, from before. Unit.
Vec3f toLamp_ws();

/// What a fibre reflects.
struct Reflection {
    float specular = 0;
    float shininess = 1;
};
/// Linear RGB towards the eye. Directions are unit; `open` and `lit` as HairLight has them.
Vec3f reflected(const Reflection& fibre, const Vec3f& albedo, const Vec3f& along_ws, const Vec3f& toEye_ws,
                float open, float lit);

}  // namespace hairloom::cards
