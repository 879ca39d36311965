// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a whole frame of moving hair costs: simulated, followed, shaded and drawn as the viewport does while
// something moves, without its window.

#include <map>
#include <memory>
#include <string>

#include "core/live/moving_hair.h"
#include "core/render/renderer.h"

namespace hairloom {

/// Means of a frame, milliseconds and bytes. Of a GPU the times are those that its clock has.
struct LiveCost {
    std::uint64_t hairs = 0;
    double simulate = 0, follow = 0, shadow = 0, shade = 0, draw = 0, wall = 0;
    double toDevice = 0, fromDevice = 0;
    double pointBytes = 0;                 ///< of all points that are drawn, once
    std::map<std::string, double> passes;  ///< on the device, ms

    double frame() const { return simulate + follow + shadow + shade + draw; }
};

class LiveLoop {
  public:
    /// Pictures of that size. The device outlives it.
    LiveLoop(gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels, std::uint32_t width,
             std::uint32_t height);
    /// Of `frames` ≥ 1 frames of 1/60 s after some that are not counted. Errors: those of GroomScene and
    /// MovingHair.
    Result<LiveCost> run(const Groom& groom, const HeadMotion& motion, EngineKind engine,
                         std::uint32_t frames);

  private:
    struct Stage;
    Status setUp(const GroomScene& groom);
    Status play(Stage& stage, std::uint32_t count);
    void add(const std::vector<gpu::PassTime>& times);
    double& sumOf(std::string_view pass);

    gpu::Device& device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
    render::RenderOptions options_;
    render::Renderer renderer_;
    gpu::TexturePtr target_;
    LiveCost cost_;
};

}  // namespace hairloom
