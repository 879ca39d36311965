// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Guides in one groom with the hairs that follow them, as programs want it that interpolate anew.

#include <span>
#include <vector>

#include "core/groom/groom.h"
#include "core/interpolation/follow_hairs.h"

namespace hairloom {

/// The points of the binding's guides, guide after guide, out of those of all strands.
std::vector<Vec3f> guidePoints(const Groom& groom, const FollowBindings& bindings,
                               std::span<const Vec3f> positions);

/// The guides of the binding, then `hairs`, which follow them in its order. Strands are numbered by their
/// places; guides are flagged, and each hair has the numbers of its three guides (groom_closest_guides_0 … 2,
/// the first again where one has no share) and their shares (groom_guide_weights). Layers, groups and roots
/// on the scalp are kept.
Groom guidesBesideHairs(const Groom& groom, const FollowBindings& bindings, const Groom& hairs);

}  // namespace hairloom
