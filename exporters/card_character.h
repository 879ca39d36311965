// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The bones of a groom's character, for files of cards.

#include <span>
#include <vector>

#include "core/cards/glb.h"
#include "core/groom/groom.h"
#include "core/groom/validate.h"

namespace hairloom {

/// Hair on cards: the groom that it is of, and where each strand of the chain has its root (Chain::roots_ws).
struct CardRoots {
    const Groom& groom;
    std::span<const Vec3f> roots_ws;
};

/// Bones that roots and collision spheres move with, and those that these hang on; of each root the four
/// strongest, of the skin nearest to it. None where the groom names no character with bones. Findings say
/// what cannot be had: the character, or the bone of a sphere.
cards::Character cardCharacter(const CardRoots& hair, std::vector<Finding>& findings);

/// The same as a VRM 1.0 avatar of a name: with the bones of a humanoid, which the character's skeleton has
/// by their names, or which are put below its head. A finding says so.
cards::Character avatarCharacter(const CardRoots& hair, const std::string& name,
                                 std::vector<Finding>& findings);

}  // namespace hairloom
