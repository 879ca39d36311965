// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A frame of the simulation, back on the head at rest.

#include <vector>

#include "core/simulation/motion.h"

namespace hairloom {

/// Points of the groom in the scalp's rest space, metres: each strand moved and turned back as the scalp has
/// been at its root, which is where it is authored. `positions_ws` and the pose are of one frame.
std::vector<Vec3f> restPositions(const Groom& groom, std::span<const Vec3f> positions_ws,
                                 const HeadPose& pose);

}  // namespace hairloom
