// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures of hair while it is simulated, without a record between.

#include "core/live/live_hair.h"
#include "core/render/picture.h"

namespace hairloom::cli {

class LiveShots {
  public:
    /// `motion` and `device` outlive it.
    static Result<std::unique_ptr<LiveShots>> make(gpu::Device& device,
                                                   std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                                   GroomScene scene, const HeadMotion& motion,
                                                   EngineKind engine);

    /// Strands at rest.
    const GroomScene& scene() const { return live_.scene(); }
    /// After so many frames of 1/60 s, not fewer than at the last call; `scene` says camera, lights and
    /// background. Of a temporal picture all frames before are drawn as well.
    Result<render::Picture> take(std::uint64_t frame, const render::RenderScene& scene,
                                 const render::RenderOptions& how);

  private:
    LiveShots(gpu::Device& device, LiveHair live)
        : device_(device), live_(std::move(live)), renderer_(device) {}

    gpu::Device& device_;
    LiveHair live_;
    render::Renderer renderer_;
    bool shown_ = false;
    std::uint64_t frame_ = 0;
};

}  // namespace hairloom::cli
