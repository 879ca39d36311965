// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hair collides with, fitted to the head of a groom and moved by the bones of its character.

#include <string>
#include <vector>

#include "core/groom/groom.h"
#include "core/simulation/bake_body.h"

namespace hairloom {

/// Thin parts, as ears are, need fine distances: in a third of it hair comes 2 to 3 mm deep there.
inline constexpr std::size_t kMostBodyBytes = 1'000'000;

/// The character's, or none with a warning where the groom's own file cannot be read. Errors: a file that
/// `character` names and that cannot be.
Result<std::shared_ptr<const Actor>> actorForColliders(const std::string& character, const Groom& groom);

/// Puts spheres on bones.
void attachSpheres(const Actor& actor, std::span<CollisionSphere> spheres);

/// Bakes the skin of the groom's head where its hair reaches, finer until no skin lies farther out than
/// `error` metres, or it is as fine as fits into `mostBytes`, which the notes
/// then say.
Result<BakedBody> fitBody(const Groom& groom, const Actor* actor, float error = 0.001f,
                          std::size_t mostBytes = kMostBodyBytes);

}  // namespace hairloom
