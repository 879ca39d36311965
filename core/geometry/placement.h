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
    /// Metres. For darts: no two roots are closer (Euclidean), and every point of the scalp with full density
    /// has a root within this distance. 0 for random placement.
    float radius = 0;
};

/// Uniform random points by area: the number on each face follows its share of the (masked) area, positions
/// are uniform over the face. Errors: nothing to place, empty selection, mask of the wrong length.
Result<Placement> placeRandom(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request);

/// Maximal Poisson-disk sampling by hierarchical dart throwing on the surface (Cline et al. 2009). Gives
/// exactly `count` roots when a count is asked for, and as many as the density asks within 3 % otherwise, by
/// choosing the radius; a mask scales the local radius by 1/√density. Errors: as placeRandom; a density above
/// what disks of the radius can reach (the message names the density that would fit).
Result<Placement> placeDarts(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request);

/// Dart throwing with the radius given (metres): maximal, no root pair closer than `radius`.
Result<Placement> placeDartsWithRadius(const ScalpMesh& mesh, const FaceSet& faces, float radius,
                                       std::span<const float> mask, std::uint64_t seed);

/// Smallest Euclidean distance between any two roots, metres; +infinity for fewer than two.
float minimumRootDistance(const ScalpMesh& mesh, std::span<const SurfacePoint> roots);

}  // namespace hairloom
