// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/root_rotations.h"

#include "core/animation/root_motion.h"

namespace hairloom {

std::vector<Quatf> rootRotations(const Groom& rest, const Groom& posed, const HeadPose& pose) {
    const std::vector<SurfacePoint> roots = rest.rootBindings();
    if (!rest.scalp || roots.empty())
        return std::vector<Quatf>(rest.strandCount(), Quatf(pose.head_ws.linear()));
    std::vector<Quatf> rotations;
    for (const auto& transform : rootTransforms(*rest.scalp, posed.scalp->positions(), roots))
        rotations.emplace_back(transform.linear());
    return rotations;
}

}  // namespace hairloom
