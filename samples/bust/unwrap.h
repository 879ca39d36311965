// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Texture coordinates: every connected piece of a patch becomes one chart.

#include "core/base/result.h"
#include "samples/bust/mesher.h"

namespace hairloom::bust {

/// A patch mesh whose vertices are copied where charts meet, with one texture coordinate each.
struct UnwrappedMesh {
    PatchMesh mesh;
    std::vector<Vec2d> uv;      ///< in [0, 1], v upwards
    std::vector<int> original;  ///< vertex of the mesh before copying
    int charts = 0;
};

/// As-rigid-as-possible charts (Liu et al. 2008, CGAL) at one common scale, packed into the unit square
/// without overlap. Fails when a piece is no disc or its chart folds over.
Result<UnwrappedMesh> unwrap(const PatchMesh& mesh);

}  // namespace hairloom::bust
