// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What both placements share: checks, density and masked area. Private to core/geometry.

#include <cstdint>
#include <span>

#include "core/geometry/placement.h"

namespace hairloom {

Status checkPlacement(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask);

/// Densities at the corners of a triangle, in [0, 1].
inline Vec3f cornerDensities(const ScalpMesh& mesh, std::span<const float> mask, std::uint32_t triangle) {
    if (mask.empty()) return Vec3f::Ones();
    const Triangle& t = mesh.triangles()[triangle];
    return {mask[t[0]], mask[t[1]], mask[t[2]]};
}

/// Number of roots that a request asks for. Errors: none or too many to hold (with the density that would
/// fit).
Result<std::size_t> requestedCount(const PlacementRequest& request, double maskedSquareMetres);

}  // namespace hairloom
