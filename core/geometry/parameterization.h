// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A selection of a mesh laid flat.

#include <vector>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

/// One disc of the selection with its flat image.
struct Chart {
    FaceSet faces;
    std::vector<Vec2d> cornerUvs;  ///< 3 per face of `faces`, metres as nearly as flattening allows
    double stretch = 1;  ///< area-weighted mean of max(σ1/σ2) over the faces; 1 is free of angle error
};

struct Parameterization {
    std::vector<Chart> charts;
};

/// Lays the selection flat without folds, piece by piece. The mesh's own UVs serve where they are free of
/// folds and overlaps and of low distortion (stretch ≤ 2); otherwise CGAL computes some (pieces that are not
/// discs are cut first). Errors: empty selection.
Result<Parameterization> parameterize(const ScalpMesh& mesh, const FaceSet& faces);

}  // namespace hairloom
