// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a groom's material means to the renderer.

#include "core/scene/groom_scene.h"

namespace hairloom {

/// The material as the view and its shading model see it. A look is in it only where the hair does not look
/// the same everywhere: it has other colours or pigment at the tip, streaks, dye, strands of their own
/// colour, random pigment or light of its own.
render::HairMaterial renderMaterial(const Groom& groom, const ViewFile& view);

/// Of the groom's own strands, by their roots at rest and the attributes `dye`.
StreakAndDyeWeights weightsOfStrands(const Groom& groom);
/// Of follow hairs: by their own roots at rest, and the dye of the guides around them. Errors: hairs that
/// cannot be evaluated.
Result<StreakAndDyeWeights> weightsOfFollowHairs(const Groom& groom, const FollowBindings& bindings);
/// The painted dye of the guides around each point of a follow hair; empty where none was painted.
std::vector<float> pointDyesOfFollowHairs(const Groom& groom, const FollowBindings& bindings);

}  // namespace hairloom
