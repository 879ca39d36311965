// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Collision spheres of a groom as a set: the capsules between them, and what their union is.

#include <functional>
#include <span>
#include <vector>

#include "core/groom/groom.h"
#include "hairloom/strands.h"

namespace hairloom {

/// As the engine has it.
runtime::Sphere toSphere(const Vec3f& centre, float radius);
/// Tapered capsules that the spheres make. What is joined with itself or with no sphere makes none.
std::vector<runtime::Capsule> capsulesOf(std::span<const CollisionSphere> spheres);
/// Those that `keeps` says yes to, by number, and the capsules between them.
std::vector<CollisionSphere> keptSpheres(std::span<const CollisionSphere> spheres,
                                         const std::function<bool(std::size_t)>& keeps);
/// Adds spheres that are joined among each other alone.
void appendSpheres(std::vector<CollisionSphere>& spheres, std::span<const CollisionSphere> more);

/// Metres from the union of spheres and capsules, below 0 inside; infinity without any.
class ColliderDistance {
  public:
    /// The spheres are looked at while it lives; `centres` instead of theirs, where there are as many.
    explicit ColliderDistance(std::span<const CollisionSphere> spheres, std::span<const Vec3f> centres = {});
    float operator()(const Vec3f& point) const;

  private:
    std::vector<runtime::Sphere> spheres_;
    std::vector<runtime::Capsule> capsules_;
};

}  // namespace hairloom
