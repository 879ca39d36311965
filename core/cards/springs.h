// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How chains of joints swing in engines (VRMC_springBone 1.0), and springs that swing as the hair does.

#include <algorithm>
#include <array>
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
/// The colliders with these numbers.
std::vector<Collider> collidersMetBy(const Rig& rig, std::size_t chain, std::span<const Collider> colliders);

/// Where the joints of a chain come to rest under a head that is still: metres from where they are, the
/// farthest.
float settling(const Rig& rig, std::size_t chain, const Spring& spring);

/// Updates a second that springs are fitted for unless another rate is asked for. They swing differently at
/// any other: VRMC_springBone keeps (1 - drag) of a joint's way an update, however long that is.
inline constexpr float kSpringHz = 60;
/// Rates that engines run at, which reports tell of.
inline constexpr std::array<float, 4> kEngineHz{30, 60, 120, 144};

/// How chains are wanted to move, frame by frame, the first at rest.
struct ChainMotion {
    float hz = kSpringHz;                       ///< frames a second
    std::vector<Eigen::Isometry3f> heads_ws;    ///< from rest
    std::vector<std::vector<Vec3f>> joints_ws;  ///< by frames, of all chains, as in the rig but for its first
};

/// The same motion at another rate, with where its head is at each frame of that: joints lie between theirs
/// on curves through them (Catmull and Rom 1974), as seen from the head.
ChainMotion atRate(const ChainMotion& motion, float hz, std::span<const Eigen::Isometry3f> heads_ws);

/// Where the joints of a chain are at each frame of such a motion of the head, with which its first joint
/// goes. Springs are updated once a frame.
std::vector<std::vector<Vec3f>> swing(const Rig& rig, std::size_t chain, const Spring& spring,
                                      std::span<const Eigen::Isometry3f> heads_ws,
                                      std::span<const Collider> colliders, float hz = kSpringHz);

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

/// What springs do in an engine that updates them at that rate.
struct SpringRate {
    float hz = 0;
    SpringError error;
};

/// How springs come to be what they are.
struct SpringFit {
    std::string motion;  ///< of the head
    double seconds = 0;
    float hz = kSpringHz;           ///< that they are fitted for
    std::vector<SpringRate> rates;  ///< kEngineHz, and what they are fitted for where that is another
    SpringError before, after;      ///< as they were set, and fitted
    double settlingMm = 0;          ///< settling() of the chain with the largest, fitted
};

/// By chains, the springs that keep the joints nearest to where they are wanted, by the mean of squares, and
/// under a still head to where they are at rest. At rest no joint touches a collider. The same for any number
/// of threads. Errors: stopped.
Result<std::vector<Spring>> fitSprings(const Rig& rig, const ChainMotion& wanted,
                                       std::span<const Collider> colliders, Cancel cancel);

}  // namespace hairloom::cards
