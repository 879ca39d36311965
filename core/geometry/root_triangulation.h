// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Delaunay triangles between roots, for interpolation between three strands (thesis §4.2).

#include <span>
#include <vector>

#include "core/geometry/parameterization.h"
#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// Triangles of root indices, counter-clockwise seen from outside. Each chart is triangulated by itself, so
/// none bridges a hole of the selection or joins two pieces. Roots that share a position keep one as a
/// vertex; the others are listed in `coincident` with the root they fall on.
struct RootTriangulation {
    std::vector<Triangle> triangles;
    struct Coincident {
        std::uint32_t root;
        std::uint32_t sameAs;
    };
    std::vector<Coincident> coincident;
    /// Roots in no triangle: all of them where they are fewer than three or on a line, and those on a piece
    /// of the selection that holds fewer than three, which have none without bridging a gap. Elsewhere they
    /// are rare: one root in some 200,000 on the heads measured.
    std::vector<std::uint32_t> alone;
};

/// The plain Delaunay triangles of each chart that lie inside the chart: their circles are empty of all roots
/// of the chart, which border constraints would spoil. A root that this leaves without a triangle gets the
/// Delaunay triangle that reaches least over the border, where it only cuts off a bend of it, at most half as
/// deep as the side that cuts it is long; failing that, the smallest triangle inside the chart between it and
/// roots near it that it sees, whose circle is empty of these. Errors: empty selection, a root outside it.
Result<RootTriangulation> triangulateRoots(const ScalpMesh& mesh, const FaceSet& faces,
                                           std::span<const SurfacePoint> roots);

}  // namespace hairloom
