// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures of hair while it is simulated, without a record between.

#include "core/groom/time_line.h"
#include "core/live/moving_hair.h"
#include "core/render/picture.h"
#include "core/simulation/time_line_motion.h"

namespace hairloom::cli {

class LiveShots {
  public:
    /// `motion`, `device` and `view` outlive it. `settings` are authored; the scene's groom has those that
    /// `motion` begins with. `line`: keys of the scene's material, in the motion's time; null: none.
    static Result<std::unique_ptr<LiveShots>> make(
        gpu::Device& device, std::shared_ptr<gpu_simulation::KernelLibrary> kernels, GroomScene scene,
        const HeadMotion& motion, const runtime::SimulationSettings& settings, const FramePace& pace,
        EngineKind engine, const ViewFile& view, std::shared_ptr<const TimeLine> line);

    /// Strands at rest.
    const GroomScene& scene() const { return scene_; }
    /// After so many frames, not fewer than at the last call; `scene` says camera, lights and
    /// background. Of a temporal picture all frames before are drawn as well.
    Result<render::Picture> take(std::uint64_t frame, const render::RenderScene& scene,
                                 const render::RenderOptions& how);

  private:
    LiveShots(gpu::Device& device, GroomScene scene, const HeadMotion& motion,
              const runtime::SimulationSettings& settings, const FramePace& pace, MovingHair hair,
              const ViewFile& view, std::shared_ptr<const TimeLine> line)
        : device_(device),
          scene_(std::move(scene)),
          motion_(motion),
          keyed_(motion, settings),
          pace_(pace),
          hair_(std::move(hair)),
          view_(view),
          line_(std::move(line)),
          authored_(scene_.rest().material),
          renderer_(device) {}
    /// All steps of the next frame but the last, which goes into the frame's own list.
    Status stepWithin(std::uint64_t frame);
    /// The keyed material at that time of the motion, to scene and renderer.
    Status giveMaterial(float seconds);

    gpu::Device& device_;
    GroomScene scene_;
    const HeadMotion& motion_;
    KeyedSettings keyed_;
    FramePace pace_;
    MovingHair hair_;
    const ViewFile& view_;
    std::shared_ptr<const TimeLine> line_;  ///< null: the material has no keys
    HairMaterial authored_;
    render::Renderer renderer_;
    bool shown_ = false;
    std::uint64_t frame_ = 0;
};

}  // namespace hairloom::cli
