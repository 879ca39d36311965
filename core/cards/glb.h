// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards and shells as binary glTF 2.0: meshes with textures and a skin, levels by MSFT_lod, joints that swing
// by VRMC_springBone 1.0.

#include "core/cards/levels.h"

namespace hairloom::cards {

/// A sphere that swinging joints keep out of; moves with the head. World space, metres.
struct Collider {
    Vec3f centre_ws;
    float radius = 0;
};

/// The levels of cards and shells of a chain, the nearest first; strands are left out. Textures lie in the
/// file as PNG. The same chain gives the same bytes. Errors: no level that glTF can hold, more than 4 GB.
Result<std::vector<std::byte>> glbOf(const std::vector<const Level*>& levels,
                                     std::span<const Collider> colliders);

}  // namespace hairloom::cards
