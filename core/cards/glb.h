// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards and shells as binary glTF 2.0: meshes with textures and a skin, levels by MSFT_lod, joints that swing
// by VRMC_springBone 1.0.

#include <vector>

#include "core/cards/character.h"
#include "core/cards/levels.h"
#include "core/cards/springs.h"

namespace hairloom::cards {

/// How vertices are written: as floats, or as integers by KHR_mesh_quantization, 40 bytes each in place of
/// 88: positions to 1/65534 of the hair's extent, normals to half a degree.
enum class GlbNumbers { floats, quantised };

/// The levels of cards and shells of a chain, the nearest first, with its rig and springs; strands are left
/// out. Textures lie in the file as PNG. Bones of the character become nodes by their names, so that an
/// engine finds the avatar's. Roots move with the bones of their skin, each chain hangs on the bone of most
/// of its roots, and colliders on theirs. `extras` of the file has `spring_hz`, the rate that springs were
/// fitted for. The same chain gives the same bytes. Errors: no level that glTF can hold, more than 4 GB, work
/// that was stopped.
Result<std::vector<std::byte>> glbOf(const Chain& chain, std::span<const Collider> colliders,
                                     GlbNumbers numbers = GlbNumbers::floats, const Character& character = {},
                                     Cancel cancel = nullptr);

}  // namespace hairloom::cards
