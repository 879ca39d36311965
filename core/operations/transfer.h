// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hairstyle on another head.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/work_watch.h"
#include "core/groom/groom.h"

namespace hairloom {

class SurfaceTree;

/// What a fit scales at most.
inline constexpr float kMinHeadScale = 0.2f, kMaxHeadScale = 5;

/// Heads of different size: x on the old one is scale · x + shift on the new one.
struct HeadFit {
    float scale = 1;
    Vec3f shift = Vec3f::Zero();  ///< metres
};

struct PlacesFit {
    HeadFit fit;
    double off = 0;  ///< metres on the old head: mean distance of its places to the new one
};
/// The fit of some places of a head, with its crown, to another. Any number of threads may ask `tree`.
PlacesFit fitPlaces(std::span<const Vec3f> places, const Vec3f& crown, const SurfaceTree& tree,
                    const Vec3f& crownThere);
/// The middle of what lies in the top twentieth of a mesh, at its top.
Vec3f crownOf(const ScalpMesh& mesh);

struct Transfer {
    HeadFit fit;
    bool sameMesh = false;  ///< the heads have the same triangles: roots keep theirs
    /// Per strand, metres: how far its root was from the new head when fitted; 0 on the same mesh.
    std::vector<float> distances;
    bool baked = false;  ///< operators went: what they name are places on the old head
};

/// Puts the groom onto `head`, which stands upright and looks the same way as the old one. Heads are fitted
/// by size and place, by their crowns first and then by the nearest points of the scalp (iterative closest
/// points, Besl and McKay 1992, without turning). Each strand goes with its root onto the nearest place of
/// the new head, turned as the skin is there, sized as the heads are, and is kept outside. Scalp selection
/// and spheres go along; density does not. Errors, which leave the groom as it was: no scalp or strands that
/// are not bound to it, a head without triangles, stopped.
Result<Transfer> transferTo(Groom& groom, std::shared_ptr<const ScalpMesh> head, const WorkWatch& watch = {});

}  // namespace hairloom
