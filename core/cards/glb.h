// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards and shells as binary glTF 2.0: meshes with textures and a skin, levels by MSFT_lod, joints that swing
// by VRMC_springBone 1.0.

#include <string>
#include <utility>
#include <vector>

#include "core/cards/levels.h"
#include "core/cards/springs.h"

namespace hairloom::cards {

/// How vertices are written: as floats, or as integers by KHR_mesh_quantization, 40 bytes each in place of
/// 88: positions to 1/65534 of the hair's extent, normals to half a degree.
enum class GlbNumbers { floats, quantised };

/// Bones of the character that hair grows on: those that head and colliders move with, and all that these
/// hang on.
struct Character {
    struct Bone {
        std::string name;
        std::int32_t parent = -1;  ///< an earlier bone; -1: none
        Eigen::Affine3f bind_ws = Eigen::Affine3f::Identity();
    };
    std::vector<Bone> bones;
    std::int32_t head = -1;  ///< that the rig hangs on; -1: none, and there are no bones
    /// Bones by VRM's names of a humanoid: the file is a VRM 1.0 avatar of the name, then. Empty: it is none.
    std::vector<std::pair<std::string, std::int32_t>> humanoid;
    std::string name;
};

/// The levels of cards and shells of a chain, the nearest first, with its rig and springs; strands are left
/// out. Textures lie in the file as PNG. Bones of the character become nodes by their names, so that an
/// engine finds the avatar's; the rig hangs on the head's, and colliders on theirs. The same chain gives the
/// same bytes. Errors: no level that glTF can hold, more than 4 GB.
Result<std::vector<std::byte>> glbOf(const Chain& chain, std::span<const Collider> colliders,
                                     GlbNumbers numbers = GlbNumbers::floats,
                                     const Character& character = {});

}  // namespace hairloom::cards
