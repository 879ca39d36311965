// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "core/simulation/frame_record.h"

namespace hairloom {

struct PlayedRange {
    std::uint32_t count = 0;     ///< frames, those of the handles among them
    float framesPerSecond = 60;  ///< at least 1
    std::uint32_t preRoll = 0;   ///< frames on the first pose that go before and are not among them
    /// Of `count`, how many come before the motion's time 0.
    std::uint32_t handles = 0;
};

/// The hair in the frames of a motion, from rest on, simulated on the CPU with its groom's settings.
/// `progress` is told the frames that are done; where it returns false that ends with an error. Errors:
/// those of Simulation::make.
Result<std::vector<RecordedFrame>> playFrames(const Groom& groom, const HeadMotion& motion,
                                              const PlayedRange& range,
                                              const std::function<bool(std::uint32_t)>& progress);

/// The same, one frame after another: each goes to `take` with its number, and an error of that ends it.
Status visitFrames(const Groom& groom, const HeadMotion& motion, std::uint32_t count, float framesPerSecond,
                   const std::function<Status(std::uint32_t, RecordedFrame)>& take);

}  // namespace hairloom
