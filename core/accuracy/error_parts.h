// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the error of a run is made of.

#include "core/accuracy/grid_hair.h"
#include "core/accuracy/work_precision.h"

namespace hairloom {

/// Splits the errors of runs of that grid, one after the other; runs that serve several are kept.
class ErrorSplitter {
  public:
    /// `settings` are the scene's. All of them outlive it.
    ErrorSplitter(const GridHair& hair, const std::vector<GridAxis>& axes,
                  const runtime::SimulationSettings& settings, std::span<const HeadPose> poses,
                  const SceneTime& time, const GroundTruth& exact);

    /// Nothing where one of the runs that it takes is not finite. `run` has its trajectory of the compared
    /// points. Errors: those of Simulation::make.
    Result<std::optional<ErrorParts>> split(const WorkPrecisionRun& run);

  private:
    struct Converged {
        Trajectory trajectory;
        TrajectoryError doubt;  ///< from the same with half of its steps
    };
    /// The run with short steps and so many points, 0 for its own; of rods in place of its strands, if so.
    Result<const Converged*> converged(const std::vector<double>& values, std::uint32_t points, bool rods);

    const GridHair& hair_;
    const std::vector<GridAxis>& axes_;
    const runtime::SimulationSettings& settings_;
    std::span<const HeadPose> poses_;
    std::vector<HeadPose> framePoses_;
    const SceneTime& time_;
    const GroundTruth& exact_;
    std::map<std::vector<double>, Converged> made_;
};

}  // namespace hairloom
