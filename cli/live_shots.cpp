// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/live_shots.h"

namespace hairloom::cli {
namespace {

constexpr float kFrame = 1.0f / 60;  // seconds

}  // namespace

Result<std::unique_ptr<LiveShots>> LiveShots::make(gpu::Device& device,
                                                   std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                                   GroomScene scene, const HeadMotion& motion,
                                                   EngineKind engine) {
    auto hair =
        MovingHair::make(engine, device, std::move(kernels), scene, motion.skin(), {motion.poseAt(0)});
    if (!hair) return tl::unexpected(hair.error());
    return std::unique_ptr<LiveShots>(new LiveShots(device, std::move(scene), motion, std::move(*hair)));
}

Result<render::Picture> LiveShots::take(std::uint64_t frame, const render::RenderScene& scene,
                                        const render::RenderOptions& how) {
    if (!shown_) {
        if (auto set = renderer_.setScene(scene); !set) return tl::unexpected(set.error());
        shown_ = true;
    }
    if (auto set = renderer_.setCamera(scene.camera, !how.temporal); !set) return tl::unexpected(set.error());
    gpu::SubmissionPtr last;
    for (; frame_ < frame; ++frame_) {
        auto list = device_.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (how.surface && !how.temporal && frame_ + 1 == frame) {
            if (auto past = renderer_.recordPast(**list, how); !past) return tl::unexpected(past.error());
        }
        if (auto moved = hair_.step(**list, kFrame, motion_); !moved) return tl::unexpected(moved.error());
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
