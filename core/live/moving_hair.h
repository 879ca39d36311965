// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that moves frame after frame, by the engine on the CPU or by the one on the GPU, behind one face. The
// window, the command line, the samples and the benchmarks move the hair that they draw by it.

#include <deque>
#include <map>
#include <optional>
#include <variant>

#include "core/live/device_hair.h"
#include "core/live/engine_choice.h"
#include "core/live/moving_picture.h"
#include "core/simulation/simulation.h"

namespace hairloom {

/// What moving hair begins with.
struct MovingStart {
    HeadPose pose;
    std::shared_ptr<const runtime::State> state = {};  ///< to go on from; null: at rest on the pose
    double time = 0;                                   ///< seconds, of the state
};

/// Hands what GroomScene::setMaterials() has changed to a renderer that has the scene: its strands, its
/// meshes, or both.
Status showMaterials(render::Renderer& renderer, const GroomScene& scene, bool hair, bool head);

/// Hands a scene that was posed to a renderer that has it: its strands, its meshes, or both.
Status showPosed(render::Renderer& renderer, const GroomScene& scene, bool hair, bool head);

class MovingHair {
  public:
    /// On the CPU. Errors: as for simulations; a state of other strands.
    static Result<MovingHair> onCpu(const Groom& groom, const MovingStart& start,
                                    const SimulationOptions& options = {});
    /// On a device, which outlives it. `skin`: of the scalp, by the bones that poses name; null: it is rigid.
    /// Errors: as for DeviceHair.
    static Result<MovingHair> onGpu(gpu::Device& device,
                                    std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                    const GroomScene& scene, const SkinWeights* skin,
                                    const MovingStart& start);
    /// One of the two.
    static Result<MovingHair> make(EngineKind engine, gpu::Device& device,
                                   std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                   const GroomScene& scene, const SkinWeights* skin,
                                   const MovingStart& start);

    EngineKind engine() const {
        return std::holds_alternative<Simulation>(hair_) ? EngineKind::cpu : EngineKind::gpu;
    }

    /// From the next step on, wind included. Errors, which leave all as it was: settings out of range or
    /// without a kernel, a method that is not the strand engine.
    Status setSettings(const runtime::SimulationSettings& settings);
    /// The shape that strands turn to from the next step on (Simulation::setStyle). Errors as there, and on a
    /// GPU.
    Status setStyle(std::span<const Vec3f> restPositions);
    /// How far hair follows each of the groom's poses, from the next step on. Errors as for simulations.
    Status setPoseAmounts(std::span<const float> amounts);
    /// In place of the groom's spheres, from the next step on.
    void setColliders(std::vector<CollisionSphere> spheres);
    /// Whether a GPU reports where all strands are, for marks that are drawn on them.
    void setReadsPositions(bool on);

    /// Moves hair and head by `dt` seconds to the end of the step. What a GPU does is recorded into `list`,
    /// outside a pass; submitted() is told when the list went to the device.
    Status step(gpu::CommandList& list, float dt, const HeadStep& head);
    /// To where the motion is then.
    Status step(gpu::CommandList& list, float dt, const HeadMotion& motion) {
        return step(list, dt,
                    stepOf(motion, pose_, static_cast<float>(time_),
                           static_cast<float>(time_ + static_cast<double>(dt))));
    }
    void submitted(const gpu::SubmissionPtr& submission);
    /// The same, with a list of its own.
    Status step(float dt, const HeadStep& head);
    /// Straight to the pose.
    Status step(float dt, const HeadPose& pose) { return step(dt, HeadStep{pose, {}}); }
    /// The pose of the last step.
    const HeadPose& pose() const { return pose_; }
    /// Seconds, of the last step.
    double time() const { return time_; }

    /// Hands what the last step moved to a renderer that has `scene`, which is of the same hair and, where
    /// the CPU moves it, is posed.
    Status show(render::Renderer& renderer, GroomScene& scene, bool hair = true, bool head = true);

    /// In the order of the groom's points; metres, world. Of a GPU: of a frame or two ago, and only while
    /// setReadsPositions(); else empty.
    std::span<const Vec3f> positions_ws() const;
    /// m/s, likewise; empty of a GPU, and where the method knows none.
    std::vector<Vec3f> velocities_ws() const;
    /// As they are now. Waits for the device.
    Status readPositions(std::span<Vec3f> positions_ws);
    /// For another engine to go on from; null for a method that cannot tell. Waits for the device.
    Result<std::shared_ptr<const runtime::State>> state();

    /// Since the start, with what each effect does and costs. Of a GPU: as far as it was reported by now;
    /// millisecondsPerFrame is of its last frames, 0 until it is known. One kernel moves the strands with
    /// all their effects there: these have no times, and "solve" and what else it does come behind them.
    SimulationStats stats() const;
    /// Of the last frame on the CPU: the step, and follow hairs in show(). 0 on a GPU, whose passes have
    /// times.
    double simulateMilliseconds() const { return simulateMs_; }
    double followMilliseconds() const { return followMs_; }

  private:
    MovingHair(Simulation simulation, const MovingStart& start)
        : hair_(std::move(simulation)), time_(start.time), pose_(start.pose) {}
    MovingHair(gpu::Device& device, DeviceHair hair, const MovingStart& start)
        : device_(&device), hair_(std::move(hair)), time_(start.time), pose_(start.pose) {}
    void readTimes();

    gpu::Device* device_ = nullptr;  ///< of a GPU
    std::variant<Simulation, DeviceHair> hair_;
    double time_ = 0;
    HeadPose pose_;  ///< of the last step
    double simulateMs_ = 0, followMs_ = 0;

    // Of a GPU.
    std::uint64_t frames_ = 0;
    std::deque<gpu::SubmissionPtr> timed_;  ///< whose times have not been read
    double frameMs_ = 0;                    ///< mean of the last frames
    std::map<FrameCost, double> costs_;     ///< likewise, ms
};

}  // namespace hairloom
