// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "core/simulation/motion.h"

namespace hairloom {

/// How the scalp has turned at the root of each strand, `posed` being `rest` in that pose.
std::vector<Quatf> rootRotations(const Groom& rest, const Groom& posed, const HeadPose& pose);

}  // namespace hairloom
