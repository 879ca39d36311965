// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/played_frames.h"

#include "core/simulation/simulation.h"

namespace hairloom {

Result<std::vector<RecordedFrame>> playFrames(const Groom& groom, const HeadMotion& motion,
                                              std::uint32_t count, float framesPerSecond,
                                              const std::function<bool(std::uint32_t)>& progress,
                                              std::uint32_t preRoll) {
    HeadPose pose = inWorld(motion.poseAt(0));
    auto simulation = Simulation::make(groom, pose);
    if (!simulation) return tl::unexpected(simulation.error());
    std::vector<RecordedFrame> frames;
    for (std::uint32_t frame = 0; frame < preRoll; ++frame) {
        if (!progress(frame)) return fail("it was cancelled");
        simulation->step(1 / framesPerSecond, pose);
    }
    for (std::uint32_t frame = 0; frame < count; ++frame) {
        if (!progress(preRoll + frame)) return fail("it was cancelled");
        if (frame > 0) {
            pose = inWorld(motion.poseAt(static_cast<float>(frame) / framesPerSecond));
            simulation->step(1 / framesPerSecond, pose);
        }
        const auto positions_ws = simulation->positions_ws();
        frames.push_back({{positions_ws.begin(), positions_ws.end()}, pose, framesPerSecond});
    }
    return frames;
}

}  // namespace hairloom
