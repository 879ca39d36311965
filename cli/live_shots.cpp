// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/live_shots.h"

namespace hairloom::cli {
Result<std::unique_ptr<LiveShots>> LiveShots::make(
    gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels, GroomScene scene,
    const HeadMotion& motion, const runtime::SimulationSettings& settings, const FramePace& pace,
    EngineKind engine, const ViewFile& view, std::shared_ptr<const TimeLine> line) {
    const HeadPose first = motion.poseAt(0);
    auto hair = MovingHair::make(engine, device, std::move(kernels), scene, motion.skin(), {first});
    if (!hair) return tl::unexpected(hair.error());
    std::unique_ptr<LiveShots> shots(new LiveShots(device, std::move(scene), motion, settings, pace,
                                                   std::move(*hair), view,
                                                   line && keysMaterial(*line) ? std::move(line) : nullptr));
    for (std::uint64_t step = 0; step < pace.preRoll * pace.steps(); ++step) {
        if (auto settled = shots->hair_.step(pace.dt(), first); !settled)
            return tl::unexpected(settled.error());
    }
    return shots;
}

Status LiveShots::stepWithin(std::uint64_t frame) {
    for (std::uint32_t step = 1; step < pace_.steps(); ++step) {
        const float time = pace_.timeOf(static_cast<float>(frame), step);
        if (auto given = keyed_.give(hair_, time); !given) return given;
        const HeadStep head = stepOf(motion_, hair_.pose(), time - pace_.dt(), time);
        if (auto moved = hair_.step(pace_.dt(), head); !moved) return moved;
    }
    return {};
}

Status LiveShots::giveMaterial(float seconds) {
    if (!line_) return {};
    Groom now = scene_.rest();  // shares its arrays
    now.material = materialAt(*line_, line_->timeAt(seconds), authored_);
    // The skin below has some of the hair's colour.
    const bool tints = scene_.rest().material.rootColour != now.material.rootColour;
    if (!scene_.setMaterials(now, view_))
        return fail("the keys of the material change which strands look otherwise",
                    "expected keys that leave tubes and the looks of layers as they are");
    return showMaterials(renderer_, scene_, true, tints);
}

Result<render::Picture> LiveShots::take(std::uint64_t frame, const render::RenderScene& scene,
                                        const render::RenderOptions& how) {
    if (!shown_) {
        if (auto set = renderer_.setScene(scene); !set) return tl::unexpected(set.error());
        shown_ = true;
        if (auto given = giveMaterial(0); !given) return tl::unexpected(given.error());
    }
    if (auto set = renderer_.setCamera(scene.camera, !how.temporal); !set) return tl::unexpected(set.error());
    gpu::SubmissionPtr last;
    for (; frame_ < frame; ++frame_) {
        if (auto moved = stepWithin(frame_ + 1); !moved) return tl::unexpected(moved.error());
        const float time = pace_.timeOf(static_cast<float>(frame_ + 1), pace_.steps());
        if (auto given = keyed_.give(hair_, time); !given) return tl::unexpected(given.error());
        auto list = device_.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (how.surface && !how.temporal && frame_ + 1 == frame) {
            if (auto past = renderer_.recordPast(**list, how); !past) return tl::unexpected(past.error());
        }
        if (auto given = giveMaterial(time); !given) return tl::unexpected(given.error());
        const HeadStep head = stepOf(motion_, hair_.pose(), time - pace_.dt(), time);
        if (auto moved = hair_.step(**list, pace_.dt(), head); !moved) return tl::unexpected(moved.error());
        if (auto shown = hair_.show(renderer_, scene_); !shown) return tl::unexpected(shown.error());
        if (how.temporal && frame_ + 1 < frame) {
            if (auto drawn = renderer_.record(**list, how, nullptr); !drawn)
                return tl::unexpected(drawn.error());
        }
        auto submission = device_.submit(std::move(*list));
        if (!submission) return tl::unexpected(submission.error());
        hair_.submitted(*submission);
        // No more than a frame ahead of the device.
        if (last) {
            if (auto done = last->wait(); !done) return tl::unexpected(done.error());
        }
        last = std::move(*submission);
    }
    return render::renderPicture(device_, renderer_, how);
}

}  // namespace hairloom::cli
