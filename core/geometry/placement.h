// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where strands are rooted: random by area (thesis §4.1) and Poisson-disk by dart throwing on the surface.

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

struct PlacementRequest {
    std::size_t count = 0;        ///< roots wanted; used when density is 0
    double densityPerCm2 = 0;     ///< roots per cm² where the mask is 1; 0 means use count
    std::span<const float> mask;  ///< density per vertex of the mesh in [0, 1], or empty for 1 everywhere
    std::uint64_t seed = 0;
};

struct Placement {
    std::vector<SurfacePoint> roots;
    /// Metres; 0 for random placement. For darts: no two roots are closer (Euclidean), and every point of the
    /// scalp has a root within this distance (to 0.1 %), where the mask is 1: the set is maximal.
    float radius = 0;
};

/// Uniform random points by area: the number on each face follows its share of the (masked) area, positions
/// are uniform over the face. Errors: nothing to place, empty selection, mask of the wrong length.
Result<Placement> placeRandom(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request);

/// Maximal Poisson-disk sampling by hierarchical dart throwing on the surface (Cline et al. 2009), exactly
/// `count` roots or densityPerCm2 × masked area. Darts are thrown until no other fits at a radius whose
/// maximal set holds a little fewer; the last roots go where the surface is farthest from all, which narrows
/// the radius to that distance and leaves the set maximal. A mask scales the local radius by 1/√density;
/// densities below 1/64 count as 0. Errors: as placeRandom; a density beyond what placement can tell apart
/// (10,000 per cm², 5 million roots, or the precision of the coordinates), with the density that would fit.
Result<Placement> placeDarts(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request);

/// How even a placement is (Lagae and Dutré 2008): the smallest distance between roots over that of as many
/// in a triangular lattice, which no placement in the plane exceeds. Maximal Poisson-disk sets have 0.7 to
/// 0.8, random ones nearly 0. `squareMetres`: of the scalp, weighted with the mask. 0 for fewer than two
/// roots.
double relativeRadius(double minRootDistance, std::size_t roots, double squareMetres);

/// m² of the faces, each bit of area weighted with its density; the mask as in PlacementRequest.
double maskedArea(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask);

/// Smallest Euclidean distance between any two roots, metres; +infinity for fewer than two.
float minimumRootDistance(const ScalpMesh& mesh, std::span<const SurfacePoint> roots);

}  // namespace hairloom
