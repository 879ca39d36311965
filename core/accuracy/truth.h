// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What runs are compared with.

#include <memory>
#include <string>

#include "core/accuracy/scene_run.h"

namespace hairloom {

struct Truth {
    Trajectory trajectory;
    /// Root mean square distance to the same source at half its resolution in time. Errors of runs below it
    /// say little.
    double uncertaintyMm = 0;
    std::string detail;  ///< how it came out in this scene, for reports; may be empty
};

class TruthSource {
  public:
    virtual ~TruthSource() = default;
    virtual std::string name() const = 0;         ///< "engine-converged"
    virtual std::string description() const = 0;  ///< how it is computed; one sentence for reports
    /// The material points `shares` of each strand, in the scene of `hair` and its settings. Errors: those of
    /// Simulation::make, a motion that is not finite.
    virtual Result<Truth> compute(const SceneHair& hair, const HeadMotion& motion, const SceneTime& time,
                                  std::span<const float> shares) const = 0;
};

/// The engine itself, converged as far as it goes: position Verlet, with the head where the motion has it at
/// the quarters of each frame, several Newton steps for length, no sleep, and substeps doubled from 4 to
/// `mostSubsteps` in each quarter. Of these runs the one counts that is nearest to the run before it: beyond
/// some step, single precision rounds away what a shorter one gains. It shares the engine's model and code,
/// so it tells errors of time stepping and of coarse strands, not of the model. Where doubling changes more
/// and more, `detail` says that the engine does not converge in this scene.
class EngineConverged : public TruthSource {
  public:
    /// 8 … 64.
    explicit EngineConverged(std::uint32_t mostSubsteps = 64) : mostSubsteps_(mostSubsteps) {}

    std::string name() const override { return "engine-converged"; }
    std::string description() const override;
    Result<Truth> compute(const SceneHair& hair, const HeadMotion& motion, const SceneTime& time,
                          std::span<const float> shares) const override;

  private:
    std::uint32_t mostSubsteps_;
};

}  // namespace hairloom
