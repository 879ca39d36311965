// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What runs are compared with.

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/cost/scene_run.h"

namespace hairloom {

struct GroundTruth {
    Followed followed;  ///< of what was asked for, what there is a truth of
    Trajectory trajectory;
    /// Root mean square distance to the same source at half its resolution in time. Errors of runs below it
    /// say little.
    double uncertaintyMm = 0;
    std::string detail;              ///< how it came out in this scene, for reports; may be empty
    std::vector<std::string> notes;  ///< what it does not do that this scene asks for; whole sentences
};

class GroundTruthSource {
  public:
    virtual ~GroundTruthSource() = default;
    virtual std::string name() const = 0;         ///< "engine-converged"
    virtual std::string description() const = 0;  ///< how it is computed; one sentence for reports
    /// Strands that it is meant to be asked for at once.
    virtual std::size_t maxStrands() const { return std::numeric_limits<std::size_t>::max(); }
    /// The followed points, in the scene of `hair` and its settings. Errors: those of Simulation::make, a
    /// motion that is not finite for any strand.
    virtual Result<GroundTruth> compute(const SceneHair& hair, const HeadMotion& motion,
                                        const SceneTime& time, const Followed& followed) const = 0;
};

/// The engine itself, converged as far as it goes: position Verlet, with the head where the motion has it at
/// the quarters of each frame, several Newton steps for length, no sleep, and substeps doubled from 4 to
/// `maxSubsteps` in each quarter. Of these runs the one counts that is nearest to the run before it: beyond
/// some step, single precision rounds away what a shorter one gains. It shares the engine's model and code,
/// so it tells errors of time stepping and of coarse strands, not of the model. Where doubling changes more
/// and more, `detail` says that the engine does not converge in this scene.
class EngineConverged : public GroundTruthSource {
  public:
    /// 8 … 64.
    explicit EngineConverged(std::uint32_t maxSubsteps = 64) : maxSubsteps_(maxSubsteps) {}

    std::string name() const override { return "engine-converged"; }
    std::string description() const override;
    Result<GroundTruth> compute(const SceneHair& hair, const HeadMotion& motion, const SceneTime& time,
                                const Followed& followed) const override;

  private:
    std::uint32_t maxSubsteps_;
};

/// The reference of core/simulation/reference: the model of docs/engine.md in double precision, with none of
/// the engine's code. The head is where the motion has it at the quarters of each frame. Each strand has its
/// substeps doubled until its points move by less than `toleranceMm`, and is left as it is at the most
/// substeps. Strands run in parallel, each for itself: the same bits for any number of threads.
///
/// A strand with a step that could not be solved, at its finest resolution, is left out. It leaves out sleep
/// and the maximal extension of coil springs. What the scene has of it stands in the notes, and with it how
/// far the converged engine is from the reference.
class ReferenceConverged : public GroundTruthSource {
  public:
    struct Options {
        std::size_t strands = 16;              ///< see maxStrands()
        double toleranceMm = 0.01;             ///< above 0
        std::uint32_t maxSubsteps = 64;        ///< in each quarter of a frame, a power of two from 4
        std::function<bool()> cancelled = {};  ///< from any thread; true ends it with an error
    };
    ReferenceConverged() : ReferenceConverged(Options{}) {}
    explicit ReferenceConverged(const Options& options) : options_(options) {}

    std::string name() const override { return "reference"; }
    std::string description() const override;
    std::size_t maxStrands() const override { return options_.strands; }
    /// Errors: also settings that the reference refuses, as angularStiffness 1.
    Result<GroundTruth> compute(const SceneHair& hair, const HeadMotion& motion, const SceneTime& time,
                                const Followed& followed) const override;

  private:
    Options options_;
};

}  // namespace hairloom
