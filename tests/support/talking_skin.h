// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far hair is off the skin of a bust that talks, in double precision.

#include "core/animation/actor.h"
#include "core/groom/groom.h"
#include "tests/support/talking_bust.h"

namespace hairloom::test {

/// How far a vertex follows the bone of a name.
inline double weightOf(const Actor& actor, std::size_t vertex, const char* bone) {
    double weight = 0;
    for (std::size_t slot = 0; slot < kBonesOfVertex; ++slot) {
        const float share = actor.skin().weights[vertex][slot];
        if (share > 0 && actor.skeleton().bones()[actor.skin().bones[vertex][slot]].name == bone)
            weight += static_cast<double>(share);
    }
    return weight;
}

/// Metres between the first points of strands and the skin of such a face, the farthest.
inline double offSkin(const Groom& groom, const Actor& actor, std::span<const Vec3f> points_ws,
                      const FaceAt& face) {
    const auto roots = groom.rootBindings();
    double farthest = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        Vec3d skin = Vec3d::Zero();
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t v = groom.scalp->triangles()[roots[s].triangle][static_cast<std::size_t>(c)];
            skin += static_cast<double>(roots[s].barycentric[c]) *
                    skinAt(groom.scalp->positions()[v].cast<double>(), weightOf(actor, v, "head"), face);
        }
        farthest = std::max(farthest, (points_ws[groom.offsets[s]].cast<double>() - skin).norm());
    }
    return farthest;
}

}  // namespace hairloom::test
