// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How chains of joints swing in engines (VRMC_springBone 1.0), and springs that swing as the hair does.

#include <algorithm>
#include <string>
#include <vector>

#include "core/cards/rig.h"

namespace hairloom::cards {

/// A sphere that swinging joints keep out of. World space, metres.
struct Collider {
    Vec3f centre_ws;
    float radius = 0;
    std::string bone{};  ///< of the character that it moves with; empty: with the head
};

/// What the joints of a chain have; of the joints between its first and its last the stiffness lies between.
struct Spring {
    float stiffness = 0.6f, tipStiffness = 0.6f;  ///< ≥ 0, of the first and of the last bone
    float drag = 0.4f;                            ///< 0 … 1
    float gravity = 0.2f;                         ///< ≥ 0, downwards
    float hitRadius = 0.008f;                     ///< metres

    float stiffnessAt(std::uint32_t joint, std::uint32_t perChain) const {
        const float share = perChain > 2 ? static_cast<float>(std::min(joint, perChain - 2)) /
                                               static_cast<float>(perChain - 2)
                                         : 0.0f;
        return stiffness + share * (tipStiffness - stiffness);
    }
};

/// Numbers of the colliders that a chain is kept out of: none of its joints stands in them at rest, where
/// they would push it away at once.
std::vector<std::uint32_t> collidersOfChain(const Rig& rig, std::size_t chain,
                                            std::span<const Collider> colliders);

/// Where the joints of a chain come to rest under a head that is still: metres from where they are, the
/// farthest.
float settling(const Rig& rig, std::size_t chain, const Spring& spring);

/// How chains are wanted to move, frame by frame, 60 a second, the first at rest.
struct ChainMotion {
    std::vector<Eigen::Isometry3f> heads_ws;    ///< from rest
    std::vector<std::vector<Vec3f>> joints_ws;  ///< by frames, of all chains, as in the rig but for its first
};

/// Where the joints of a chain are at each frame of such a motion of the head, with which its first joint
/// goes.
std::vector<std::vector<Vec3f>> swing(const Rig& rig, std::size_t chain, const Spring& spring,
                                      std::span<const Eigen::Isometry3f> heads_ws,
                                      std::span<const Collider> colliders);

/// Motions of the rig's joints since rest, for skin(). `joints_ws` by chains, as swing() has them of a frame:
/// each bone turns the shortest way, as VRMC_springBone turns it, and the last joint with the bone before it.
std::vector<Eigen::Affine3f> jointMotions(const Rig& rig, const Eigen::Isometry3f& head_ws,
                                          std::span<const std::vector<Vec3f>> joints_ws);

/// How far joints are from where they are wanted, all chains and frames; the first of a chain is left out.
/// Each chain is kept out of collidersOfChain().
struct SpringError {
    double meanMm = 0, largestMm = 0;
};
SpringError springError(const Rig& rig, std::span<const Spring> springs, const ChainMotion& wanted,
                        std::span<const Collider> colliders);

/// How springs come to be what they are.
struct SpringFit {
    std::string motion;  ///< of the head
    double seconds = 0;
    SpringError before, after;  ///< as they were set, and fitted
    double settlingMm = 0;      ///< settling() of the chain with the largest, fitted
};

/// By chains, the springs that keep the joints nearest to where they are wanted, by the mean of squares, and
/// under a still head to where they are at rest. At rest no joint touches a collider. The same for any number
/// of threads. Errors: stopped.
Result<std::vector<Spring>> fitSprings(const Rig& rig, const ChainMotion& wanted,
                                       std::span<const Collider> colliders, Cancel cancel);

}  // namespace hairloom::cards
