// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/live_hair.h"

#include <algorithm>

#include "core/base/stopwatch.h"

namespace hairloom {

Result<LiveHair> LiveHair::make(gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                GroomScene scene, const HeadMotion& motion, EngineKind engine) {
    LiveHair hair(device, std::move(kernels), motion, std::move(scene));
    if (auto made = hair.goOn(engine, nullptr); !made) return tl::unexpected(made.error());
    return hair;
}

/// With that engine, from a state or at rest.
Status LiveHair::goOn(EngineKind engine, const runtime::State* state) {
    if (engine == EngineKind::gpu) {
        auto made = DeviceHair::make(*device_, kernels_, scene_, motion_->skin(), poseNow());
        if (!made) return tl::unexpected(made.error());
        if (auto written = state ? made->writeState(*state) : Status(); !written) return written;
        gpu_.emplace(std::move(*made));
        cpu_.reset();
        return {};
    }
    auto made = Simulation::make(scene_.rest(), poseNow());
    if (!made) return tl::unexpected(made.error());
    if (state && !made->setState(*state, time_)) return fail("the state does not belong to these strands");
    cpu_.emplace(std::move(*made));
    gpu_.reset();
    return {};
}

Status LiveHair::setEngine(EngineKind engine) {
    if (engine == this->engine()) return {};
    if (cpu_) return goOn(engine, cpu_->state().get());
    const auto state = gpu_->readState();
    return state ? goOn(engine, state->get()) : Status(tl::unexpected(state.error()));
}

Status LiveHair::record(gpu::CommandList& list, render::Renderer& renderer, float dt) {
    time_ += static_cast<double>(dt);
    const HeadPose pose = poseNow();
    simulateMs_ = followMs_ = 0;
    if (gpu_) {
        if (auto recorded = gpu_->record(list, dt, time_, pose); !recorded) return recorded;
        return gpu_->show(renderer, true, true);
    }
    Stopwatch watch;
    cpu_->step(dt, pose);
    if (auto status = cpu_->status(); !status) return status;
    simulateMs_ = 1e3 * watch.seconds();
    watch = {};
    scene_.pose(cpu_->positions_ws(), cpu_->velocities_ws(), pose);
    followMs_ = 1e3 * watch.seconds();
    const render::RenderScene moved = scene_.scene();
    for (std::size_t i = 0; i < moved.meshes.size(); ++i) {
        const render::RenderMesh& mesh = moved.meshes[i];
        auto set = renderer.setMeshPositions(i, mesh.positions_ws, mesh.normals_ws);
        if (!set) return set;
    }
    return renderer.setStrandPositions(0, moved.strands.front().positions_ws);
}

void LiveHair::submitted(const gpu::SubmissionPtr& submission) {
    if (gpu_) gpu_->submitted(submission);
}

Status LiveHair::readPositions(std::span<Vec3f> positions_ws) {
    if (gpu_) return gpu_->readPositions(positions_ws);
    std::ranges::copy(cpu_->positions_ws(), positions_ws.begin());
    return {};
}

}  // namespace hairloom
