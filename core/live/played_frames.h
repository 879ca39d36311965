// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "core/simulation/frame_record.h"

namespace hairloom {

/// The hair in `count` frames of a motion, from rest on, simulated on the CPU with its groom's settings.
/// `progress` is told the frames that are done; where it returns false that ends with an error. Errors:
/// those of Simulation::make. `preRoll` frames on the first pose go before, which are not among them.
Result<std::vector<RecordedFrame>> playFrames(const Groom& groom, const HeadMotion& motion,
                                              std::uint32_t count, float framesPerSecond,
                                              const std::function<bool(std::uint32_t)>& progress,
                                              std::uint32_t preRoll = 0);

/// The same, one frame after another: each goes to `take` with its number, and an error of that ends it.
Status visitFrames(const Groom& groom, const HeadMotion& motion, std::uint32_t count, float framesPerSecond,
                   const std::function<Status(std::uint32_t, RecordedFrame)>& take);

}  // namespace hairloom
