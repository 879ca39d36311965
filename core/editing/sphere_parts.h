// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Collision spheres for what hair meets beside the head: a collar, a hat, a scarf.

#include <atomic>
#include <span>
#include <string>

#include "core/editing/sphere_fit.h"

namespace hairloom::editing {

inline constexpr std::uint32_t kMaxPartSpheres = 256;  ///< for all parts

struct SpherePart {
    std::string name;  ///< of its group
    FaceSet faces;     ///< ascending, at least one
};

/// Spheres named "group:NAME 1", "group:NAME 2" … Each part is fitted on its own, since one may lie in
/// another. `count` (1 … kMaxPartSpheres) is shared by area, and each part has one at least and 64 at most.
/// The gaps and the bulge are those of all parts together. Stops early once `cancelled` is set. Errors: those
/// of fitSpheres(), cancelled.
Result<SphereFit> fitSpheresToParts(const ScalpMesh& mesh, std::span<const SpherePart> parts,
                                    std::uint32_t count, const std::atomic<bool>* cancelled = nullptr);

/// Of these, the ones that fitSpheresToParts() made: another fit to the head leaves them.
std::vector<CollisionSphere> spheresOfParts(std::span<const CollisionSphere> spheres);

}  // namespace hairloom::editing
