// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A measured setting as motion to look at: all strands with its settings, at the points that the groom has.

#include <functional>
#include <vector>

#include "core/accuracy/work_precision.h"

namespace hairloom {

struct RunPreview {
    std::vector<HeadPose> poses;  ///< one a frame
    std::vector<std::vector<Vec3f>>
        positions_ws;  ///< one a frame, per point of the groom, from its pose's origin
};

/// The frames that `measured` ran, with the settings and points of one of its runs. Errors: those of
/// Simulation::make, being cancelled.
Result<RunPreview> previewRun(const Groom& groom, const HeadMotion& motion, const WorkPrecision& measured,
                              std::size_t run, const std::function<bool()>& cancelled);

/// The strands of the groom that are farthest apart in two previews of it, by their farthest points in any
/// frame: the `share` (0…1, at least one) of all that is worst; ascending. Those that agree are left out.
std::vector<std::uint32_t> strandsFarthestApart(const Groom& groom, const RunPreview& a, const RunPreview& b,
                                                double share);

}  // namespace hairloom
