// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Chains of joints that cards hang on, for engines that move no strands.

#include <array>

#include "core/cards/cards.h"

namespace hairloom::cards {

struct Joint {
    Vec3f position_ws;
    std::int32_t parent = -1;  ///< -1: the first, which is the head's
};

/// Joint 0 is the head's. Chain c has the joints 1 + c · perChain …, root first; the first of them stays
/// with the head.
struct Rig {
    std::uint32_t perChain = 2;
    std::vector<Joint> joints{Joint{Vec3f::Zero(), -1}};
    std::vector<std::vector<Vec3f>> curves;  ///< of each chain, kStations points
    std::size_t chains() const { return curves.size(); }
};

/// What files of cards have, and what moving them is timed with.
inline constexpr std::uint32_t kChains = 24, kJointsPerChain = 5;

/// `chains` at most, of `perChain` ≥ 2 joints, through the middles of cards that lie together. Errors:
/// stopped.
Result<Rig> makeRig(const Cards& cards, std::uint32_t chains, std::uint32_t perChain, Cancel cancel);

/// What each vertex of a mesh hangs on: four joints and their weights, ≥ 0, sum 1. Joints of no weight are 0;
/// 0 may stand there several times.
struct Binding {
    std::vector<std::array<std::uint16_t, 4>> joints;
    std::vector<Vec4f> weights;
};
/// To the two chains nearest to each card, by the way along it. Roots hang on the head's joint.
Binding bind(const Rig& rig, const Cards& cards);

/// Moves vertices by their joints' motions since rest.
void skin(const Binding& binding, const CardMesh& mesh, std::span<const Eigen::Affine3f> motions,
          std::span<Vec3f> positions_ws);

}  // namespace hairloom::cards
