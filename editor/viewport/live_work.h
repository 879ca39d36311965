// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that is simulated where it is drawn: what the render thread keeps of it. Used on that thread only.

#include <map>

#include "core/live/device_hair.h"
#include "core/live/engine_choice.h"
#include "core/simulation/simulation.h"

namespace hairloom::editor {

/// What a simulation on the device begins with.
struct LiveStart {
    std::shared_ptr<const Groom> groom;
    std::shared_ptr<const HeadMotion> motion;  ///< has the skin
    HeadPose pose;
    std::shared_ptr<const runtime::State> state;  ///< to go on from; null: at rest on the pose
};

/// A frame, and what changes with it.
struct LiveStep {
    float dt = 0;     ///< seconds
    double time = 0;  ///< at its end
    HeadPose pose;
    std::optional<runtime::SimulationSettings> settings;
    std::optional<std::vector<CollisionSphere>> spheres;
    bool wantsPositions = false;  ///< marks show where strands are
};

/// What has come back of frames, a frame or two late.
struct LiveReport {
    DeviceFrame frame;
    /// One kernel moves the strands with all their effects: behind these, which have no times, come the
    /// "solve", and what else the device does for them.
    std::vector<EffectReport> effects;
    double milliseconds = 0;  ///< of a frame on the device, mean of the last ones; 0: not known yet
};

class LiveWork {
  public:
    /// `device` outlives it.
    explicit LiveWork(gpu::Device& device) : device_(device) {}

    EngineChoice choose(EngineWish wish, const Groom& groom);
    Status start(const LiveStart& start);
    Status step(const LiveStep& step);
    void stop() { hair_.reset(); }
    /// Waits for the device. Null where nothing plays.
    Result<std::shared_ptr<const runtime::State>> readState();
    const LiveReport& report() const { return report_; }

    /// Whether a renderer that shows this scene can show the hair that plays.
    bool fits(const GroomScene& scene) const;
    Status show(render::Renderer& renderer, bool hair, bool head) const {
        return hair_->show(renderer, hair, head);
    }

  private:
    const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels();
    void time(gpu::SubmissionPtr submission);

    gpu::Device& device_;
    std::shared_ptr<gpu_simulation::KernelLibrary> kernels_;
    std::optional<DeviceHair> hair_;
    std::size_t drawnPoints_ = 0, vertices_ = 0;
    std::deque<gpu::SubmissionPtr> timed_;  ///< whose times have not been read
    std::map<std::string, double> times_;   ///< of what is told apart, ms, mean of the last frames
    LiveReport report_;
};

}  // namespace hairloom::editor
