// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/rest_positions.h"

#include "core/animation/root_motion.h"

namespace hairloom {

std::vector<Vec3f> restPositions(const Groom& groom, std::span<const Vec3f> positions_ws,
                                 const HeadPose& pose) {
    const HeadPose world = inWorld(pose);
    const std::vector<SurfacePoint> roots = groom.rootBindings();
    std::vector<Mat3f> turns(groom.strandCount(), world.head_ws.linear());
    if (groom.scalp && !roots.empty() && !world.scalpPositions_ws.empty()) {
        const auto transforms = rootTransforms(*groom.scalp, world.scalpPositions_ws, roots);
        for (std::size_t s = 0; s < turns.size(); ++s) turns[s] = transforms[s].linear();
    }
    std::vector<Vec3f> rest(positions_ws.begin(), positions_ws.end());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::size_t first = groom.offsets[s];
        const Vec3f root = groom.strand(s)[0];
        for (std::size_t p = first + 1; p < groom.offsets[s + 1]; ++p)
            rest[p] = root + turns[s].transpose() * (positions_ws[p] - positions_ws[first]);
        rest[first] = root;
    }
    return rest;
}

std::vector<Vec3f> posedPositions(const Groom& groom, const HeadPose& pose) {
    const HeadPose world = inWorld(pose);
    const std::vector<SurfacePoint> roots = groom.rootBindings();
    std::vector<Eigen::Isometry3f> moves(groom.strandCount(), world.head_ws);
    if (groom.scalp && !roots.empty() && !world.scalpPositions_ws.empty())
        moves = rootTransforms(*groom.scalp, world.scalpPositions_ws, roots);
    const auto rest = groom.positions();
    std::vector<Vec3f> posed(rest.size());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (std::size_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p) posed[p] = moves[s] * rest[p];
    }
    return posed;
}

}  // namespace hairloom
