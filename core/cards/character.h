// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The character's own bones under cards and shells, by the weights of the skin that hair grows on.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/cards/level_arrays.h"

namespace hairloom::cards {

/// Bones of the character that hair grows on: those that roots and colliders move with, and all that these
/// hang on.
struct Character {
    struct Bone {
        std::string name;
        std::int32_t parent = -1;  ///< an earlier bone; -1: none
        Eigen::Affine3f bind_ws = Eigen::Affine3f::Identity();
    };
    /// The bones that move the skin at a root; weights ≥ 0, sum 1. Bones of no weight are 0.
    struct Root {
        std::array<std::uint16_t, 4> bones{};
        Vec4f weights = Vec4f(1, 0, 0, 0);
    };
    std::vector<Bone> bones;
    std::int32_t head = -1;   ///< that most roots move with; -1: none, and there are no bones
    std::vector<Root> roots;  ///< of each strand of the chain; empty: all move with the head
    /// Bones by VRM's names of a humanoid: the file is a VRM 1.0 avatar of the name, then. Empty: it is none.
    std::vector<std::pair<std::string, std::int32_t>> humanoid;
    std::string name;
};

/// Gives what hangs on the head's joint to the character's bones, numbered behind the rig's joints: each
/// vertex moves as the skin at the nearest root does, of its card's strands or, in a cap or a shell, of all.
/// The four strongest joints of a vertex are kept. Nothing where the character has no roots.
void hangOnBones(const Level& level, const Chain& chain, const Character& character, LevelArrays& arrays);

/// The bone that each chain of the rig hangs on: that of most roots to which the chain is the nearest, the
/// head where there are none.
std::vector<std::int32_t> bonesOfChains(const Chain& chain, const Character& character);

}  // namespace hairloom::cards
