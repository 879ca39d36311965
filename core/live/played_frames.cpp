// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/played_frames.h"

#include "core/simulation/simulation.h"
#include "core/simulation/time_line_motion.h"

namespace hairloom {

namespace {

/// As visitFrames(); `before` is told of every frame before it is simulated, those of the run-up among them.
Status play(const Groom& groom, const HeadMotion& motion, const PlayedRange& range,
            const std::function<bool(std::uint32_t)>& before,
            const std::function<Status(std::uint32_t, RecordedFrame)>& take) {
    const FramePace pace{range.framesPerSecond, range.preRoll};
    const std::uint32_t steps = pace.steps();
    const auto timeOf = [&](std::uint32_t frame, std::uint32_t step) {
        return pace.timeOf(static_cast<float>(frame) - static_cast<float>(range.handles), step);
    };
    HeadPose last = motion.poseAt(timeOf(0, steps)), pose = inWorld(last);
    KeyedSettings keyed(motion, groom.simulation, timeOf(0, steps));
    Groom begun = groom;
    begun.simulation = keyed.first();
    auto simulation = Simulation::make(begun, pose);
    if (!simulation) return tl::unexpected(simulation.error());
    for (std::uint32_t frame = 0; frame < range.preRoll; ++frame) {
        if (!before(frame)) return fail("it was cancelled", "expected it to run to its end");
        for (std::uint32_t step = 1; step <= steps; ++step) simulation->step(pace.dt(), pose);
    }
    for (std::uint32_t frame = 0; frame < range.count; ++frame) {
        if (!before(range.preRoll + frame)) return fail("it was cancelled", "expected it to run to its end");
        for (std::uint32_t step = 1; frame > 0 && step <= steps; ++step) {
            const float time = timeOf(frame, step);
            if (auto given = keyed.give(*simulation, time); !given) return given;
            HeadStep head = stepOf(motion, last, time - pace.dt(), time);
            simulation->step(pace.dt(), inWorld(head));
            last = std::move(head.end);
            pose = inWorld(last);
        }
        const auto positions_ws = simulation->positions_ws();
        auto taken = take(frame, {{positions_ws.begin(), positions_ws.end()}, pose, range.framesPerSecond});
        if (!taken) return taken;
    }
    return {};
}

}  // namespace

Result<std::vector<RecordedFrame>> playFrames(const Groom& groom, const HeadMotion& motion,
                                              const PlayedRange& range,
                                              const std::function<bool(std::uint32_t)>& progress) {
    std::vector<RecordedFrame> frames;
    auto played = play(groom, motion, range, progress, [&](std::uint32_t, RecordedFrame frame) -> Status {
        frames.push_back(std::move(frame));
        return {};
    });
    if (!played) return tl::unexpected(played.error());
    return frames;
}

Status visitFrames(const Groom& groom, const HeadMotion& motion, std::uint32_t count, float framesPerSecond,
                   const std::function<Status(std::uint32_t, RecordedFrame)>& take) {
    return play(
        groom, motion, {count, framesPerSecond}, [](std::uint32_t) { return true; }, take);
}

}  // namespace hairloom
