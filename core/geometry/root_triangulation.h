// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Delaunay triangles between roots, for interpolation between three strands (thesis §4.2).

#include <span>
#include <vector>

#include "core/geometry/parameterization.h"
#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// Triangles of root indices, counter-clockwise seen from outside. Each chart is triangulated by itself, so
/// none bridges a hole of the selection or joins two pieces, and none leaves the selection. Roots that share
/// a place keep one as a vertex; the others are listed in `coincident` with the root they fall on.
struct RootTriangulation {
    std::vector<Triangle> triangles;
    struct Coincident {
        std::uint32_t root;
        std::uint32_t sameAs;
    };
    std::vector<Coincident> coincident;
};

/// Errors: fewer than three roots in every chart, or no parameterisation exists.
Result<RootTriangulation> triangulateRoots(const ScalpMesh& mesh, const FaceSet& faces,
                                           std::span<const SurfacePoint> roots);

}  // namespace hairloom
