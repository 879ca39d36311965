// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Work and precision: what each of a grid of settings costs in a scene and how far its hair is from the
// truth.

#include <functional>
#include <string>
#include <vector>

#include "core/accuracy/grid.h"
#include "core/accuracy/ground_truth.h"
#include "core/accuracy/other_errors.h"
#include "core/cost/statistics.h"

namespace hairloom {

/// What trades accuracy for time in every scene: substeps, corrections of length where strands are springs
/// that have some, and points per strand; around what the groom has, and with it.
std::vector<GridAxis> axesToTry(const Groom& groom);

struct WorkPrecision;

struct WorkPrecisionOptions {
    std::vector<GridAxis> axes;         ///< each combination of their values is run
    SceneTime time;                     ///< stepsPerFrame is 1
    std::uint32_t strands = 200;        ///< ≥ 1; a sample of a larger groom, but for kGuidesAxis
    std::uint32_t repeats = 5;          ///< timed runs of each setting, ≥ 1; the first one is not timed
    std::uint64_t seed = 1;             ///< of the sample
    std::uint32_t pointsCompared = 16;  ///< on each strand, evenly spaced by arc length
    /// A run whose root mean square error is larger has diverged; 0 stands for a quarter of the longest
    /// strand.
    double divergedAboveMm = 0;
    MethodMaker gpuEngine = {};     ///< that runs the engine "gpu" of kEngineAxis
    bool keepTrajectories = false;  ///< of the compared points, for showing them
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// Called after each round of timed runs with what is known by then.
    std::function<void(const WorkPrecision&)> partial;
    std::function<bool()> cancelled;  ///< asked between runs; true ends them with an error
};

/// Substeps in 1/60 s that stand for infinitely many.
inline constexpr std::uint32_t kConvergedSubsteps = 64;

/// What the error of a run is made of, each found by itself: they need not add up.
struct ErrorParts {
    TrajectoryError step;    ///< from the same converged, up to kConvergedSubsteps; its doubt at least
    TrajectoryError points;  ///< from that one to the same with twice the points of the finest in the grid
    /// From the rod to the finest strands of this model, converged: springs, guides, contact, hair
    /// against hair, single precision. The rod is the truth, or the engine's where the truth is of springs.
    TrajectoryError model;
};

struct WorkPrecisionRun {
    std::vector<double> values;   ///< one for each axis
    bool diverged = false;        ///< then there are no numbers
    Quartiles milliseconds = {};  ///< of the engine, per frame: of the means of the repeated runs
    TrajectoryError error = {};
    OtherErrors other = {};
    /// Of runs on the front and of the groom's own settings, once all is measured.
    std::optional<ErrorParts> parts = {};
    bool onFront = false;  ///< no other run is both as fast and as exact (median time, root mean square)
    std::uint64_t stateHash = 0;
    Trajectory trajectory = {};  ///< of the compared points, where it was asked for and did not diverge
    /// Springs that would be on the front, but tremble where the head stands still: m/s, or 0.
    double trembling = 0;
};

struct WorkPrecision {
    WorkPrecisionOptions options;          ///< with divergedAboveMm settled
    runtime::SimulationSettings settings;  ///< of the scene: what no axis varies
    std::string groundTruthName;
    std::string groundTruthDescription;
    std::string groundTruthDetail;
    double groundTruthUncertaintyMm = 0;
    Trajectory groundTruthTrajectory;     ///< where it was asked for: `pointsCompared` a strand
    std::uint32_t groundTruthPoints = 0;  ///< per strand; 0 as authored
    std::size_t groomStrands = 0;
    std::size_t strands = 0;             ///< that ran
    std::size_t strandsCompared = 0;     ///< of those, the ones that errors are taken from
    std::vector<WorkPrecisionRun> runs;  ///< the last axis turns fastest
    std::vector<std::string> notes;      ///< what a reader must know; whole sentences
};

/// Errors: an axis that is neither a field nor named above, values out of its range, a GPU without
/// gpuEngine (all of them checked before anything runs), a groom that cannot be simulated, being cancelled.
Result<WorkPrecision> measureWorkPrecision(const Groom& groom, const HeadMotion& motion,
                                           const WorkPrecisionOptions& options,
                                           const GroundTruthSource& groundTruth);

}  // namespace hairloom
