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
    /// Roots whose every Delaunay triangle would leave the scalp (on a spit narrower than the roots are
    /// apart).
    std::vector<std::uint32_t> alone;
};

/// The plain Delaunay triangulation of each chart, less the triangles that cross the chart's border: those
/// kept have empty circles among all roots of the chart, which border constraints would spoil. Errors: empty
/// selection, a root outside it, no triangle at all.
Result<RootTriangulation> triangulateRoots(const ScalpMesh& mesh, const FaceSet& faces,
                                           std::span<const SurfacePoint> roots);

}  // namespace hairloom
