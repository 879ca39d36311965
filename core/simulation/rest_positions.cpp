// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/rest_positions.h"

#include "core/animation/root_motion.h"

namespace hairloom {

namespace {

/// How each strand's root has moved since the head was at rest.
std::vector<Eigen::Isometry3f> movesOf(const Groom& groom, const HeadPose& pose) {
    const HeadPose world = inWorld(pose);
    const std::vector<SurfacePoint> roots = groom.rootBindings();
    if (groom.scalp && !roots.empty() && !world.scalpPositions_ws.empty())
        return rootTransforms(*groom.scalp, world.scalpPositions_ws, roots);
    return std::vector<Eigen::Isometry3f>(groom.strandCount(), world.head_ws);
}

}  // namespace

std::vector<Vec3f> restPositions(const Groom& groom, std::span<const Vec3f> positions_ws,
                                 const HeadPose& pose) {
    const std::vector<Eigen::Isometry3f> moves = movesOf(groom, pose);
    std::vector<Vec3f> rest(positions_ws.begin(), positions_ws.end());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::size_t first = groom.offsets[s];
        const Vec3f root = groom.strand(s)[0];
        const Mat3f turn = moves[s].linear();
        for (std::size_t p = first + 1; p < groom.offsets[s + 1]; ++p)
            rest[p] = root + turn.transpose() * (positions_ws[p] - positions_ws[first]);
        rest[first] = root;
    }
    return rest;
}

std::vector<Vec3f> posedPositions(const Groom& groom, const HeadPose& pose) {
    const std::vector<Eigen::Isometry3f> moves = movesOf(groom, pose);
    const auto rest = groom.positions();
    std::vector<Vec3f> posed(rest.size());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (std::size_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p) posed[p] = moves[s] * rest[p];
    }
    return posed;
}

}  // namespace hairloom
