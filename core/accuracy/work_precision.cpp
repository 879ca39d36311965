// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/work_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <set>

#include "core/accuracy/thread_limit.h"
#include "core/geometry/curve.h"
#include "hairloom/stable.h"

namespace hairloom {
namespace {

std::uint32_t largestCount(const std::vector<double>& values) {
    return static_cast<std::uint32_t>(*std::ranges::max_element(values));
}

double longestStrandMm(const Groom& groom) {
    float longest = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        longest = std::max(longest, polylineLength(groom.strand(s)));
    }
    return 1e3 * static_cast<double>(longest);
}

/// The hair of every combination of the grid, resampled once for each number of points.
class GridHair {
  public:
    GridHair(SceneHair authored, const WorkPrecisionOptions& options)
        : axes_(options.axes),
          gpuEngine_(options.gpuEngine),
          points_(findAxis(axes_, kPointsAxis)),
          threads_(findAxis(axes_, kThreadsAxis)),
          engine_(findAxis(axes_, kEngineAxis)),
          hairHair_(findAxis(axes_, kHairHairAxis)),
          spheres_(findAxis(axes_, kSpheresAxis)) {
        if (points_) {
            for (const double points : axes_[*points_].values) {
                byPoints_[points] = resampledHair(authored, static_cast<std::uint32_t>(points));
            }
        }
        authored_ = std::move(authored);
    }

    SceneHair at(const std::vector<double>& values) const {
        SceneHair hair = points_ ? byPoints_.at(values[*points_]) : authored_;
        applyValues(axes_, values, hair.groom.simulation);
        if (spheres_ && static_cast<double>(hair.groom.spheres.size()) > values[*spheres_])
            hair.groom.spheres.resize(static_cast<std::size_t>(values[*spheres_]));
        return hair;
    }
    /// What runs it.
    SimulationOptions optionsAt(const std::vector<double>& values) const {
        SimulationOptions options;
        if (engine_ && values[*engine_] > 0) options.backend = gpuEngine_;
        if (hairHair_ && values[*hairHair_] > 0) options.hairHair = runtime::HairVolumeSettings();
        return options;
    }
    /// The finest strands of the grid with the scene's own settings.
    SceneHair finest() const { return points_ ? byPoints_.rbegin()->second : authored_; }

    ThreadLimit limitThreads(const std::vector<double>& values) const {
        return threads_ ? ThreadLimit(static_cast<std::size_t>(values[*threads_])) : ThreadLimit();
    }

  private:
    const std::vector<GridAxis>& axes_;
    const MethodMaker& gpuEngine_;
    std::optional<std::size_t> points_, threads_, engine_, hairHair_, spheres_;
    SceneHair authored_;
    std::map<double, SceneHair> byPoints_;
};

/// Counts runs for whoever watches.
class Counted {
  public:
    Counted(const WorkPrecisionOptions& options, std::size_t total) : options_(options), total_(total) {}
    void add(std::size_t runs = 1) {
        done_ += runs;
        if (options_.progress) options_.progress(done_, total_);
    }

  private:
    const WorkPrecisionOptions& options_;
    std::size_t total_, done_ = 0;
};

Status unlessCancelled(const WorkPrecisionOptions& options) {
    if (options.cancelled && options.cancelled()) return fail("measuring was cancelled");
    return {};
}

/// Where each run's hair goes; the first run of each setting, which also warms the caches.
Status followAll(const GridHair& hair, std::span<const HeadPose> poses, const Trajectory& groundTruth,
                 const Followed& followed, WorkPrecision& result, Counted& counted) {
    for (WorkPrecisionRun& run : result.runs) {
        if (auto status = unlessCancelled(result.options); !status) return status;
        const ThreadLimit limit = hair.limitThreads(run.values);
        auto outcome =
            runScene(hair.at(run.values), poses, result.options.time, followed, hair.optionsAt(run.values));
        if (!outcome) return tl::unexpected(outcome.error());
        run.stateHash = outcome->stateHash;
        run.diverged = !outcome->trajectory.finite || outcome->nanCount > 0 || outcome->restoredStrands > 0;
        if (!run.diverged) {
            run.error = compare(outcome->trajectory, groundTruth);
            run.diverged = !(run.error.rmsMm <= result.options.divergedAboveMm);
        }
        if (run.diverged) run.error = {};
        if (result.options.keepTrajectories && !run.diverged) run.trajectory = std::move(outcome->trajectory);
        counted.add(run.diverged ? 1 + result.options.repeats : 1);
    }
    return {};
}

/// The greatest speed of followed points, m/s, after some seconds of a head at rest in still air; 0 where it
/// is slower than hair at rest may be. Motion is damped at least as fast as by default, so that it does not
/// swing on.
Result<double> tremblingAtRest(SceneHair hair, const HeadPose& pose, const Followed& followed,
                               const SimulationOptions& options) {
    runtime::SimulationSettings& settings = hair.groom.simulation;
    if (settings.strandModel == runtime::StrandModel::rods) return 0.0;
    const float usual = runtime::SimulationSettings().dampingTime;
    settings.windSpeed = 0;
    settings.dampingTime = settings.dampingTime > 0 ? std::min(settings.dampingTime, usual) : usual;
    SceneTime time;
    time.frames = static_cast<std::uint32_t>(runtime::kTrialSeconds * 60);
    const std::vector<HeadPose> still(time.frames + 1, pose);
    const auto outcome = runScene(hair, still, time, followed, options);
    if (!outcome) return tl::unexpected(outcome.error());
    const Trajectory& run = outcome->trajectory;
    if (!run.finite) return std::numeric_limits<double>::infinity();
    constexpr std::size_t kLastFrames = 10;
    float farthest = 0;
    for (std::size_t i = run.points_ws.size() - kLastFrames * run.pointsPerFrame; i < run.points_ws.size();
         ++i)
        farthest = std::max(farthest, (run.points_ws[i] - run.points_ws[i - run.pointsPerFrame]).norm());
    const double speed = static_cast<double>(farthest * time.framesPerSecond);
    return speed > static_cast<double>(runtime::kTrialSpeed) ? speed : 0.0;
}

/// Of the runs that neither diverge nor tremble.
void markFront(WorkPrecision& result) {
    std::vector<std::pair<double, double>> pairs;
    for (const WorkPrecisionRun& run : result.runs) {
        const double never = std::numeric_limits<double>::infinity();
        const bool out = run.diverged || run.trembling > 0;
        pairs.emplace_back(out ? never : run.milliseconds.median, out ? never : run.error.rmsMm);
    }
    const std::vector<bool> front = paretoFront(pairs);
    for (std::size_t r = 0; r < result.runs.size(); ++r) result.runs[r].onFront = front[r];
}

/// What trembles at rest is not recommended: without it the front is found again.
Status findFront(const GridHair& hair, const HeadPose& pose, const Followed& followed,
                 WorkPrecision& result) {
    std::set<std::size_t> calm;
    for (bool settled = false; !settled;) {
        markFront(result);
        settled = true;
        for (std::size_t r = 0; r < result.runs.size(); ++r) {
            WorkPrecisionRun& run = result.runs[r];
            if (!run.onFront || !calm.insert(r).second) continue;
            if (auto status = unlessCancelled(result.options); !status) return status;
            const auto speed =
                tremblingAtRest(hair.at(run.values), pose, followed, hair.optionsAt(run.values));
            if (!speed) return tl::unexpected(speed.error());
            run.trembling = *speed;
            settled = settled && !(*speed > 0);
        }
    }
    return {};
}

/// What is left with short steps, and what is not.
Status splitErrors(const GridHair& hair, std::span<const HeadPose> poses, const GroundTruth& exact,
                   WorkPrecision& result) {
    for (WorkPrecisionRun& run : result.runs) {
        if (!run.onFront) continue;
        if (auto status = unlessCancelled(result.options); !status) return status;
        SceneHair own = hair.at(run.values);
        const SimulationOptions options = hair.optionsAt(run.values);
        const auto as = runScene(own, poses, result.options.time, exact.followed, options);
        own.groom.simulation.substeps = kConvergedSubsteps;
        const auto fine = runScene(own, poses, result.options.time, exact.followed, options);
        if (!as) return tl::unexpected(as.error());
        if (!fine) return tl::unexpected(fine.error());
        if (!fine->trajectory.finite) continue;
        run.stepError = compare(as->trajectory, fine->trajectory);
        run.modelError = compare(fine->trajectory, exact.trajectory);
    }
    return {};
}

/// In rounds over all settings, so that a machine that warms up or is busy for a while treats them alike.
Status timeAll(const GridHair& hair, std::span<const HeadPose> poses, WorkPrecision& result,
               Counted& counted) {
    std::vector<std::vector<double>> times(result.runs.size());
    for (std::uint32_t round = 0; round < result.options.repeats; ++round) {
        for (std::size_t r = 0; r < result.runs.size(); ++r) {
            if (result.runs[r].diverged) continue;
            if (auto status = unlessCancelled(result.options); !status) return status;
            const ThreadLimit limit = hair.limitThreads(result.runs[r].values);
            const std::vector<double>& values = result.runs[r].values;
            const auto outcome =
                runScene(hair.at(values), poses, result.options.time, {}, hair.optionsAt(values));
            if (!outcome) return tl::unexpected(outcome.error());
            times[r].push_back(outcome->millisecondsPerFrame);
            counted.add();
        }
        for (std::size_t r = 0; r < result.runs.size(); ++r) {
            if (!times[r].empty()) result.runs[r].milliseconds = quartiles(times[r]);
        }
        markFront(result);
        if (result.options.partial) result.options.partial(result);
    }
    return {};
}

/// The hashes of all runs with one value of an axis, in the order of the other axes' values.
std::vector<std::uint64_t> hashesAt(const WorkPrecision& result, std::size_t axis, double value) {
    std::vector<std::uint64_t> hashes;
    for (const WorkPrecisionRun& run : result.runs) {
        if (run.values[axis] == value) hashes.push_back(run.stateHash);
    }
    return hashes;
}

/// A setting that changes no bit of any run is one that the engine does not heed in this scene, and its rows
/// would pass for measurements of something else.
void noteValuesWithoutEffect(std::size_t axisIndex, WorkPrecision& result) {
    const GridAxis& axis = result.options.axes[axisIndex];
    std::map<std::vector<std::uint64_t>, std::vector<std::string>> valuesByHashes;
    for (const double value : axis.values) {
        valuesByHashes[hashesAt(result, axisIndex, value)].push_back(axisValueText(axis, value));
    }
    for (const double value : axis.values) {  // in the order of the axis, not of the hashes
        const auto& same = valuesByHashes.at(hashesAt(result, axisIndex, value));
        if (same.size() < 2 || same.front() != axisValueText(axis, value)) continue;
        result.notes.push_back(fmt::format(
            "{} {} gave the same motion to the bit in every run: the engine does not tell them apart "
            "in this scene, so their rows do not compare them.",
            axis.field, fmt::join(same, ", ")));
    }
}

/// Kelvin-Voigt damping of bending is part of position Verlet's implicit solve alone.
void noteIntegratorsWithoutBendDamping(WorkPrecision& result) {
    if (result.settings.strandModel == runtime::StrandModel::rods) return;
    if (!(result.settings.bendDampingTime > 0) || !(result.settings.angularStiffness > 0)) return;
    const auto axis = findAxis(result.options.axes, "integrator");
    const double own = static_cast<double>(result.settings.integrator);
    const std::vector<double> used = axis ? result.options.axes[*axis].values : std::vector<double>{own};
    const auto isVerlet = [](double index) {
        return index == static_cast<double>(runtime::Integrator::verlet);
    };
    if (std::ranges::all_of(used, isVerlet)) return;
    result.notes.push_back(fmt::format(
        "Only the integrator verlet damps bending (bendDampingTime {} s); the others leave it out, "
        "which no number of substeps makes good.",
        result.settings.bendDampingTime));
}

/// Settings that are fast and exact while the head moves, and no good where it stands still.
void noteTrembling(WorkPrecision& result) {
    std::vector<std::string> settings;
    double fastest = 0;
    for (const WorkPrecisionRun& run : result.runs) {
        if (!(run.trembling > 0)) continue;
        std::vector<std::string> values;
        for (std::size_t a = 0; a < run.values.size(); ++a)
            values.push_back(axisValueText(result.options.axes[a], run.values[a]));
        settings.push_back(fmt::format("{}", fmt::join(values, "/")));
        fastest = std::max(fastest, run.trembling);
    }
    if (settings.empty()) return;
    result.notes.push_back(fmt::format(
        "Left out of the front, since the hair trembles where the head stands still (at up to {:.3g} m/s "
        "after "
        "{:.0f} s in still air: springs feed energy into curled hair, held lengths into soft hair): {}.",
        fastest, runtime::kTrialSeconds, fmt::join(settings, ", ")));
}

void noteWhatMatters(WorkPrecision& result) {
    noteIntegratorsWithoutBendDamping(result);
    for (std::size_t a = 0; a < result.options.axes.size(); ++a) {
        if (result.options.axes[a].field != kThreadsAxis) noteValuesWithoutEffect(a, result);
    }
    // An error that is not well above the truth's own tells the truth's as much as the run's.
    constexpr double kClear = 3;
    const auto unclear = std::ranges::count_if(result.runs, [&](const WorkPrecisionRun& run) {
        return !run.diverged && run.error.rmsMm < kClear * result.groundTruthUncertaintyMm;
    });
    if (unclear > 0) {
        result.notes.push_back(
            fmt::format("The truth itself moves by {:.3g} mm when its resolution in time is halved. The "
                        "errors of {} of {} runs "
                        "are less than three times that; which of these is more exact cannot be told.",
                        result.groundTruthUncertaintyMm, unclear, result.runs.size()));
        if (!result.groundTruthDetail.empty())
            result.notes.back() += fmt::format(" ({}.)", result.groundTruthDetail);
    }
    noteTrembling(result);
    const auto diverged = std::ranges::count_if(result.runs, &WorkPrecisionRun::diverged);
    if (diverged > 0) {
        result.notes.push_back(fmt::format(
            "{} of {} runs diverged (strands exploded, or a root mean square error above {:.4g} mm).",
            diverged, result.runs.size(), result.options.divergedAboveMm));
    }
    if (result.strandsCompared < result.strands) {
        result.notes.push_back(fmt::format("Errors are of {} of the {} strands that ran: the truth is slow.",
                                           result.strandsCompared, result.strands));
    }
    if (result.strands < result.groomStrands) {
        result.notes.push_back(
            fmt::format("A sample of {} of {} strands ran (seed {}); times are of the sample.",
                        result.strands, result.groomStrands, result.options.seed));
    }
}

Status checkAxes(const WorkPrecisionOptions& options) {
    std::set<std::string> seen;
    for (const GridAxis& axis : options.axes) {
        if (auto status = checkAxis(axis); !status) return status;
        if (axis.field == kEngineAxis && !options.gpuEngine &&
            std::ranges::find(axis.values, 1.0) != axis.values.end())
            return fail("the engine on a GPU is asked for and there is none", "expected cpu, or a GPU");
        if (!seen.insert(axis.field).second)
            return fail(axis.field + " varies twice", "expected one axis of it");
    }
    return {};
}

}  // namespace

std::vector<GridAxis> axesToTry(const Groom& groom) {
    const runtime::SimulationSettings& own = groom.simulation;
    std::set<double> substeps{1, 2, 4, 8, 16, 32, static_cast<double>(own.substeps)};
    std::vector<GridAxis> axes{{"substeps", {substeps.begin(), substeps.end()}}};
    const bool springs = own.strandModel == runtime::StrandModel::springs;
    if (springs && own.lengthMethod == runtime::LengthMethod::constraint && own.lengthIterations > 0) {
        std::set<double> iterations{1, 2, static_cast<double>(own.lengthIterations)};
        axes.push_back({"lengthIterations", {iterations.begin(), iterations.end()}});
    }
    constexpr std::uint32_t kFewest = 4;
    const std::uint32_t points = maxPoints(groom);
    std::set<double> counts{static_cast<double>(points)};
    for (const std::uint32_t part : {2u, 4u})
        counts.insert(std::max(points / part, std::min(points, kFewest)));
    axes.push_back({std::string(kPointsAxis), {counts.begin(), counts.end()}});
    return axes;
}

Result<WorkPrecision> measureWorkPrecision(const Groom& groom, const HeadMotion& motion,
                                           const WorkPrecisionOptions& options,
                                           const GroundTruthSource& groundTruth) {
    assert(options.repeats >= 1 && options.strands >= 1 && options.time.stepsPerFrame == 1);
    if (auto status = checkAxes(options); !status) return tl::unexpected(status.error());
    if (groom.strandCount() == 0) return fail("the groom has no strands", "expected strands to simulate");

    WorkPrecision result;
    result.options = options;
    result.settings = groom.simulation;
    result.groundTruthName = groundTruth.name();
    result.groundTruthDescription = groundTruth.description();
    result.groomStrands = groom.strandCount();
    for (auto& values : combinations(options.axes)) result.runs.push_back({.values = std::move(values)});
    SceneHair sample = sampleStrands(groom, options.strands, options.seed);
    result.strands = sample.groom.strandCount();
    if (!(options.divergedAboveMm > 0)) result.options.divergedAboveMm = longestStrandMm(sample.groom) / 4;
    if (const auto points = findAxis(options.axes, kPointsAxis)) {
        result.groundTruthPoints = largestCount(options.axes[*points].values);
    }
    const GridHair hair(std::move(sample), result.options);

    // The truth counts as one run; it takes as long as several, but how many depends on the grid.
    Counted counted(options, 1 + result.runs.size() * (1 + options.repeats));
    const SceneHair finest = hair.finest();
    const auto exact =
        groundTruth.compute(finest, motion, options.time,
                            {drawnStrands(finest.groom, groundTruth.maxStrands(), options.seed),
                             evenShares(options.pointsCompared)});
    if (!exact) return tl::unexpected(exact.error());
    result.strandsCompared = exact->followed.strands.size();
    result.groundTruthUncertaintyMm = exact->uncertaintyMm;
    result.groundTruthDetail = exact->detail;
    result.notes = exact->notes;
    if (options.keepTrajectories) result.groundTruthTrajectory = exact->trajectory;
    counted.add();

    const std::vector<HeadPose> poses = posesOf(motion, options.time);
    if (auto status = followAll(hair, poses, exact->trajectory, exact->followed, result, counted); !status) {
        return tl::unexpected(status.error());
    }
    if (auto status = timeAll(hair, poses, result, counted); !status) return tl::unexpected(status.error());
    if (auto status = findFront(hair, poses.front(), exact->followed, result); !status)
        return tl::unexpected(status.error());
    if (auto status = splitErrors(hair, poses, *exact, result); !status)
        return tl::unexpected(status.error());
    noteWhatMatters(result);
    return result;
}

}  // namespace hairloom
