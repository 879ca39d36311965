// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a step of the engine costs, on the scenes of benchmark_scenes.h, with nothing but the engine in the
// clock: roots and spheres are made before it runs.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/cost/benchmark_scenes.h"
#include "runtime/engine/strand_model.h"

namespace hairloom {

struct StepScene {
    std::uint32_t strands = 0;
    std::uint32_t points = 16;
    scenes::ActiveForces activeForces = scenes::ActiveForces::windAndSpheres;
    runtime::StrandModel model = runtime::StrandModel::rods;  ///< with its usual substeps
    bool allThreads = false;                                  ///< those of parallelFor; else one
    bool byStage = false;  ///< with a clock around each stage of each block, which costs a little itself

    runtime::SimulationSettings settings() const { return scenes::settingsFor(activeForces, model); }
};

/// Strands, and where their roots and the spheres are over time.
class MovingStrands {
  public:
    virtual ~MovingStrands() = default;
    virtual runtime::StrandsView view() const = 0;
    /// `time` in seconds; one root for each strand.
    virtual void move(double time, std::vector<runtime::RootFrame>& roots,
                      std::vector<runtime::Sphere>& spheres) const = 0;
};

/// scenes::HeadOfHair.
std::unique_ptr<MovingStrands> turningHead(std::uint32_t strands, std::uint32_t points,
                                           scenes::ActiveForces activeForces);

/// A scene that runs on from measurement to measurement.
class StepRun {
  public:
    explicit StepRun(const StepScene& scene);
    /// `settings` must be in range for these strands.
    StepRun(std::unique_ptr<MovingStrands> strands, const runtime::SimulationSettings& settings,
            bool allThreads, bool byStage = false);

    /// Milliseconds of the median one of the next `frames` ≥ 1 frames of 1/60 s; of one thread in its
    /// processor time, of all on the wall, where what else the machine does falls on few of them.
    double milliseconds(std::uint32_t frames);
    /// As many frames as take about `seconds` on this machine, 2 to 240; runs up to 20 to find out, in which
    /// the hair also comes into motion.
    std::uint32_t framesFor(double seconds);

    /// The same of each stage in the last milliseconds(), summed over threads; all 0 unless byStage.
    const std::array<double, runtime::kStageCount>& stageMilliseconds() const { return stages_; }
    const runtime::Engine& engine() const { return *engine_; }
    /// Particles times substeps of a frame.
    double work() const;

  private:
    std::unique_ptr<MovingStrands> strands_;
    std::uint32_t substeps_;
    bool onWall_;
    std::optional<runtime::Engine> engine_;
    std::vector<runtime::RootFrame> roots_;
    std::vector<runtime::Sphere> spheres_;
    std::array<double, runtime::kStageCount> stages_{};
    double time_ = 0.0;
};

/// A model's solve and nothing else: the kernels of roots and of rods, or of position Verlet, called block by
/// block, without an engine around them. What an engine with every effect off does beyond this is its
/// overhead.
class BareSolve {
  public:
    /// With the model's usual substeps.
    BareSolve(std::uint32_t strands, std::uint32_t points, runtime::StrandModel model);
    double milliseconds(std::uint32_t frames);

  private:
    void enterFrame(std::size_t block, runtime::LaneFrame& lanes);

    scenes::HeadOfHair head_;
    runtime::SimulationSettings settings_;
    std::shared_ptr<const runtime::RestShape> shape_;
    runtime::State state_;
    runtime::OwnedStrands hair_;
    runtime::EffectPlan plan_;
    runtime::Floats work_;
    std::vector<runtime::RootFrame> roots_;
    float substep_ = 0.0f;  // of the last frame
    double time_ = 0.0;
};

/// Milliseconds in which `hairs` follow their guides, the median of `frames`, as StepRun::milliseconds.
double followMilliseconds(runtime::FollowHairs& hairs, const scenes::Lawn& lawn, bool allThreads,
                          std::uint32_t frames);

/// Nanoseconds that one profiler scope costs its block, the median of `batches` of a thousand.
double profilerScopeNanoseconds(std::uint32_t batches);

}  // namespace hairloom
