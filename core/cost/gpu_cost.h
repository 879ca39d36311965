// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a frame of the strand engine costs on a GPU, and which share of it falls to each effect. Roots and
// spheres are made before the clock starts, as in step_cost.h.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/cost/step_cost.h"
#include "core/gpu_simulation/strand_engine.h"

namespace hairloom {

/// An effect that can be taken out of the scene with wind and ten spheres.
enum class LeftOut { nothing, wind, collision, angular, length, damping };
inline constexpr LeftOut kLeftOut[] = {LeftOut::nothing, LeftOut::wind,   LeftOut::collision,
                                       LeftOut::angular, LeftOut::length, LeftOut::damping};
const char* leftOutName(LeftOut effect);
/// All that acts on a head of hair but that.
runtime::SimulationSettings settingsWithout(LeftOut effect, runtime::StrandModel model);

/// How a scene is laid out on the device, by name.
struct NamedLayout {
    const char* name;
    gpu_simulation::LayoutOptions options;
};
/// Those worth measuring on such a device, its own first: a driver that compiles for a CPU takes minutes for
/// unrolled loops.
std::vector<NamedLayout> measuredLayouts(gpu::DeviceType type);
/// Of rods, beside their own: by the threads that share a strand.
std::vector<NamedLayout> measuredRodLayouts(gpu::DeviceType type);

/// Milliseconds a frame, medians.
struct GpuFrameCost {
    double device = 0.0;    ///< the dispatches, by the device's timestamps, while it is kept busy
    double wall = 0.0;      ///< from recording to the device being done, one frame at a time
    double together = 0.0;  ///< wall clock of frames that do not wait for each other, divided by their number
};

class KeptBusy;

/// A scene that runs on from measurement to measurement.
class GpuStepRun {
  public:
    /// Errors: those of StrandEngine::make.
    static Result<GpuStepRun> make(gpu::Device& device,
                                   std::shared_ptr<gpu_simulation::KernelLibrary> kernels,
                                   std::unique_ptr<MovingStrands> strands,
                                   const runtime::SimulationSettings& settings,
                                   const gpu_simulation::LayoutOptions& layout);

    /// Of `frames` ≥ 1 frames of 1/60 s. For its own clock a GPU copies memory while a frame is recorded: one
    /// that is left without work for most of the time clocks itself down.
    Result<GpuFrameCost> cost(std::uint32_t frames);
    /// As many frames as take about `seconds`, 4 to 240; runs some to find out, in which the hair comes into
    /// motion and the device to speed.
    Result<std::uint32_t> framesFor(double seconds);
    gpu_simulation::StrandEngine& engine() { return engine_; }
    /// Particles times substeps of a frame.
    double work() const;

  private:
    GpuStepRun(std::unique_ptr<MovingStrands> strands, gpu_simulation::StrandEngine engine,
               std::shared_ptr<const KeptBusy> busy);
    void nextFrame();
    Result<std::vector<double>> wallOf(std::uint32_t frames, std::vector<double>* device);
    Result<std::vector<double>> deviceOf(std::uint32_t frames, double wall);
    Result<std::vector<double>> togetherOf(std::uint32_t frames);

    std::unique_ptr<MovingStrands> strands_;
    gpu_simulation::StrandEngine engine_;
    std::shared_ptr<const KeptBusy> busy_;  // null where the device is the CPU
    std::vector<runtime::RootFrame> roots_;
    std::vector<runtime::Sphere> spheres_;
    runtime::FrameInput input_;
    double time_ = 0.0;
};

/// Bytes a second that the device reads and writes when a kernel copies buffers of up to 256 MiB, in GB/s.
Result<double> copyBandwidth(gpu::Device& device);

/// Keeps the device busy for that long: a GPU that rests clocks itself down, and takes its time to come back.
Status bringToSpeed(gpu::Device& device, double seconds);

/// Where a falling cost passes below another: `counts` ascending, costs above 0. Straight lines in the
/// logarithms between neighbours; absent where they do not cross, the first count where it is below at once.
std::optional<double> crossing(const std::vector<double>& counts, const std::vector<double>& falling,
                               const std::vector<double>& other);

}  // namespace hairloom
