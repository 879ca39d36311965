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

/// The engine itself with so many substeps that more would change little: position Verlet, 64 substeps in
/// each quarter of a frame, with the head where the motion has it at the quarters, several Newton steps for
/// length, no sleep. It shares the engine's model and its single precision, so it tells errors of
/// time stepping and of coarse strands, not errors of the model or of its code.
class EngineConverged : public TruthSource {
  public:
    explicit EngineConverged(std::uint32_t substeps = 64) : substeps_(substeps) {}

    std::string name() const override { return "engine-converged"; }
    std::string description() const override;
    Result<Truth> compute(const SceneHair& hair, const HeadMotion& motion, const SceneTime& time,
                          std::span<const float> shares) const override;

  private:
    std::uint32_t substeps_;  ///< 2 … 64, in each quarter of a frame
};

}  // namespace hairloom
