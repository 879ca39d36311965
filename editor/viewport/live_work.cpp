// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/live_work.h"

#include "core/live/moving_picture.h"
#include "core/simulation/strand_method.h"

namespace hairloom::editor {
namespace {

std::size_t drawnPointsOf(const GroomScene& scene) {
    const render::RenderScene shown = scene.scene();
    return shown.strands.empty() ? 0 : shown.strands.front().positions_ws.size();
}

std::size_t verticesOf(const GroomScene& scene) {
    return scene.rest().scalp ? scene.rest().scalp->vertexCount() : 0;
}

}  // namespace

const std::shared_ptr<gpu_simulation::KernelLibrary>& LiveWork::kernels() {
    if (!kernels_) {
        kernels_ =
            std::make_shared<gpu_simulation::KernelLibrary>(device_, gpu_simulation::userKernelFolder());
    }
    return kernels_;
}

EngineChoice LiveWork::choose(EngineWish wish, const Groom& groom) {
    return chooseEngine(wish, &device_, kernels(), groom, EngineMemory::ofUser());
}

Status LiveWork::start(const LiveStart& start) {
    hair_.reset();
    timed_.clear();
    report_ = {};
    times_.clear();
    const auto scene = GroomScene::make(*start.groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    auto made = DeviceHair::make(device_, kernels(), *scene, start.motion->skin(), start.pose);
    if (!made) return tl::unexpected(made.error());
    if (start.state) {
        if (auto written = made->writeState(*start.state); !written) return written;
    }
    hair_.emplace(std::move(*made));
    drawnPoints_ = drawnPointsOf(*scene);
    vertices_ = verticesOf(*scene);
    return {};
}

Status LiveWork::step(const LiveStep& step) {
    if (!hair_) return fail("no hair is playing on the device");
    if (step.settings) {
        if (auto set = hair_->setSettings(*step.settings); !set) return set;
    }
    if (step.spheres) hair_->setSpheres(*step.spheres);
    hair_->setReadsPositions(step.wantsPositions);
    auto list = device_.createCommandList();
    if (!list) return tl::unexpected(list.error());
    if (auto recorded = hair_->record(**list, step.dt, step.time, step.pose); !recorded) return recorded;
    auto submission = device_.submit(std::move(*list));
    if (!submission) return tl::unexpected(submission.error());
    hair_->submitted(*submission);
    time(std::move(*submission));
    report_.frame = hair_->latestFrame();
    report_.effects.clear();
    const runtime::EffectPlan& plan = hair_->engine().plan();
    for (std::uint32_t index = 0; index < runtime::kEffectCount; ++index) {
        const auto effect = static_cast<runtime::Effect>(index);
        const bool on = plan.on(effect);
        report_.effects.push_back({runtime::effectName(effect), on, reasonAlone(plan.why(effect)),
                                   on ? std::nullopt : std::optional(0.0),
                                   hair_->engine().effectBytes(effect)});
    }
    for (const auto& [part, milliseconds] : times_)
        report_.effects.push_back({part, true, "on, on the GPU", milliseconds, 0});
    return {};
}

/// Reads times of what the device has done.
void LiveWork::time(gpu::SubmissionPtr submission) {
    timed_.push_back(std::move(submission));
    while (!timed_.empty() && timed_.front()->isDone()) {
        const auto times = timed_.front()->passTimes();
        timed_.pop_front();
        if (!times) continue;
        double sum = 0;
        std::map<std::string, double> parts;
        for (const gpu::PassTime& pass : *times) {
            sum += pass.milliseconds;
            parts[std::string(frameCostName(frameCostOf(pass.name)))] += pass.milliseconds;
        }
        const auto smooth = [](double& mean, double now) {
            constexpr double kShare = 0.1;
            mean = mean > 0 ? mean + kShare * (now - mean) : now;
        };
        smooth(report_.milliseconds, sum);
        for (const auto& [part, milliseconds] : parts) smooth(times_[part], milliseconds);
    }
}

Result<std::shared_ptr<const runtime::State>> LiveWork::readState() {
    if (!hair_) return std::shared_ptr<const runtime::State>();
    return hair_->readState();
}

bool LiveWork::fits(const GroomScene& scene) const {
    return hair_ && drawnPointsOf(scene) == drawnPoints_ && verticesOf(scene) == vertices_;
}

}  // namespace hairloom::editor
