// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that moves and is drawn frame after frame, by the engine on the CPU or by the one on the GPU, behind
// one face.

#include <optional>

#include "core/live/device_hair.h"
#include "core/live/engine_choice.h"
#include "core/simulation/simulation.h"

namespace hairloom {

class LiveHair {
  public:
    /// The scene's groom at rest on the motion's first pose. Device and motion outlive it. Errors: as for
    /// simulations and DeviceHair.
    static Result<LiveHair> make(gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                 GroomScene scene, const HeadMotion& motion, EngineKind engine);

    EngineKind engine() const { return gpu_ ? EngineKind::gpu : EngineKind::cpu; }
    /// The other engine goes on from where hair is, as fast as it is; waits for the device. An error leaves
    /// all as it was.
    Status setEngine(EngineKind engine);

    /// For Renderer::setScene(), before frames are recorded.
    const GroomScene& scene() const { return scene_; }

    /// Moves hair and head on by `dt` seconds and hands them to a renderer that has the scene; what the GPU
    /// does of it is recorded, outside a pass.
    Status record(gpu::CommandList& list, render::Renderer& renderer, float dt);
    /// The list of the last record() went to the device.
    void submitted(const gpu::SubmissionPtr& submission);
    double time() const { return time_; }

    /// Of the last frame on the CPU; 0 on the GPU, whose passes have times.
    double simulateMilliseconds() const { return simulateMs_; }
    double followMilliseconds() const { return followMs_; }
    /// Waits for the device.
    Status readPositions(std::span<Vec3f> positions_ws);

  private:
    LiveHair(gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
             const HeadMotion& motion, GroomScene scene)
        : device_(&device), kernels_(std::move(kernels)), motion_(&motion), scene_(std::move(scene)) {}
    Status goOn(EngineKind engine, const runtime::State* state);
    HeadPose poseNow() const { return motion_->poseAt(static_cast<float>(time_)); }

    gpu::Device* device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
    const HeadMotion* motion_;
    GroomScene scene_;
    // One of them.
    std::optional<Simulation> cpu_;
    std::optional<DeviceHair> gpu_;
    double time_ = 0;
    double simulateMs_ = 0, followMs_ = 0;
};

}  // namespace hairloom
