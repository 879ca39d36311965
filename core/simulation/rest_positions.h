// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair without simulation: a frame back on the head at rest, and hair at rest on a head that moves.

#include <vector>

#include "core/simulation/motion.h"

namespace hairloom {

/// Points of the groom in the scalp's rest space, metres: each strand moved and turned back as the scalp has
/// been at its root, which is where it is authored. `positions_ws` and the pose are of one frame.
std::vector<Vec3f> restPositions(const Groom& groom, std::span<const Vec3f> positions_ws,
                                 const HeadPose& pose);

/// The other way: points of the groom at rest on the head in that pose, each strand moved and turned as the
/// scalp is at its root. Metres, world space.
std::vector<Vec3f> posedPositions(const Groom& groom, const HeadPose& pose);

}  // namespace hairloom
