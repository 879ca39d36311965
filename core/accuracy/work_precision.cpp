// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/work_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <set>

#include "core/accuracy/choice.h"
#include "core/accuracy/error_parts.h"
#include "core/accuracy/measures.h"
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
    if (options.cancelled && options.cancelled())
        return fail("measuring was cancelled", "expected it to run to its end");
    return {};
}

/// Where each run's hair goes; the first run of each setting, which also warms the caches.
Status followAll(const GridHair& hair, std::span<const HeadPose> poses, const Trajectory& groundTruth,
                 const Followed& followed, WorkPrecision& result, Counted& counted) {
    const std::vector<HeadPose> framePoses = framePosesOf(poses, result.options.time);
    for (WorkPrecisionRun& run : result.runs) {
        if (auto status = unlessCancelled(result.options); !status) return status;
        const ThreadLimit limit = hair.limitThreads(run.values);
        auto outcome = runScene(hair.at(run.values), poses, hair.timeAt(run.values, result.options.time),
                                {hair.followedAt(followed.strands, run.values), followed.shares},
                                hair.optionsAt(run.values));
        if (!outcome) return tl::unexpected(outcome.error());
        hair.moveToOwnRoots(run.values, followed, framePoses, outcome->trajectory);
        run.stateHash = outcome->stateHash;
        run.diverged = !outcome->trajectory.finite || outcome->nanCount > 0 || outcome->restoredStrands > 0;
        if (!run.diverged) {
            run.error = compare(outcome->trajectory, groundTruth);
            run.diverged = !(run.error.rmsMm <= result.options.divergedAboveMm);
        }
        if (run.diverged) {
            run.error = {};
        } else {
            run.trajectory = std::move(outcome->trajectory);
            run.other.sphereDepthMm = outcome->sphereDepthMm;
        }
        counted.add(run.diverged ? 2 + result.options.repeats : 1);
    }
    return {};
}

constexpr std::size_t kRestingStrands = 16;  // that are let rest, of those that are compared

/// How each setting holds its shape and lies on head and spheres.
Status findOtherErrors(const GridHair& hair, const Groom& groom, std::span<const HeadPose> poses,
                       std::vector<std::uint32_t> strands, WorkPrecision& result, Counted& counted) {
    std::vector<const Trajectory*> trajectories;
    for (const WorkPrecisionRun& run : result.runs) trajectories.push_back(&run.trajectory);
    const std::vector<double> depths =
        headDepths(groom, framePosesOf(poses, result.options.time), trajectories);
    const std::size_t every = (strands.size() + kRestingStrands - 1) / kRestingStrands;
    for (std::size_t s = 0; s * every < strands.size(); ++s) strands[s] = strands[s * every];
    strands.resize((strands.size() + every - 1) / every);
    for (std::size_t r = 0; r < result.runs.size(); ++r) {
        WorkPrecisionRun& run = result.runs[r];
        if (run.diverged) continue;
        if (auto status = unlessCancelled(result.options); !status) return status;
        run.other.headDepthMm = depths[r];
        SceneHair some = hair.alone(hair.at(run.values), strands, run.values).hair;
        const bool springs = some.groom.simulation.strandModel == runtime::StrandModel::springs;
        const auto rested =
            measureRest(std::move(some), poses.front(), hair.optionsAt(run.values), run.other);
        if (!rested) return rested;
        const bool trembles = run.other.restSpeed > static_cast<double>(runtime::kTrialSpeed);
        if (springs && trembles) run.trembling = run.other.restSpeed;
        counted.add();
    }
    return {};
}

void markFront(WorkPrecision& result) {
    const std::vector<bool> front = frontBy(result, Measure::distance);
    for (std::size_t r = 0; r < result.runs.size(); ++r) result.runs[r].onFront = front[r];
}

/// What is left with short steps, and what is not, of the runs that a reader looks at.
Status splitErrors(const GridHair& hair, const Groom& groom, std::span<const HeadPose> poses,
                   const GroundTruth& exact, WorkPrecision& result) {
    ErrorSplitter splitter(hair, result.options.axes, result.settings, poses, result.options.time, exact);
    const auto own = runOf(result, groom);
    for (std::size_t r = 0; r < result.runs.size(); ++r) {
        WorkPrecisionRun& run = result.runs[r];
        if (run.diverged || (!run.onFront && own != r)) continue;
        if (auto status = unlessCancelled(result.options); !status) return status;
        auto parts = splitter.split(run);
        if (!parts) return tl::unexpected(parts.error());
        run.parts = *parts;
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
            const auto outcome = runScene(hair.at(values), poses, hair.timeAt(values, result.options.time),
                                          {}, hair.optionsAt(values), hair.followersAt(values));
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
        result.notes.push_back(
            fmt::format("{} {} gave the same motion to the bit in every run. The engine does not distinguish "
                        "them in this scene, so their rows do not compare them.",
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
    result.notes.push_back(
        fmt::format("Only the integrator verlet damps bending (bendDampingTime {} s). The others ignore it, "
                    "and more substeps do not change that.",
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
        "Not on the front, because the hair trembles while the head is still (at up to {:.3g} m/s after "
        "{:.0f} s in still air: springs feed energy into curled hair, and fixed lengths into soft hair): {}.",
        fastest, runtime::kTrialSeconds, fmt::join(settings, ", ")));
}

void noteWhatMatters(WorkPrecision& result) {
    noteIntegratorsWithoutBendDamping(result);
    for (std::size_t a = 0; a < result.options.axes.size(); ++a) {
        const std::string& field = result.options.axes[a].field;
        if (field != kThreadsAxis && field != kHairsPerGuideAxis) noteValuesWithoutEffect(a, result);
    }
    // An error that is not well above the truth's own tells the truth's as much as the run's.
    constexpr double kClear = 3, kNothing_mm = 1e-6;
    const auto unclear = std::ranges::count_if(result.runs, [&](const WorkPrecisionRun& run) {
        return !run.diverged && run.error.rmsMm < kClear * result.groundTruthUncertaintyMm;
    });
    if (unclear > 0 && result.groundTruthUncertaintyMm > kNothing_mm) {
        result.notes.push_back(
            fmt::format("The reference moves by {:.3g} mm when its time step is halved. The errors of {} of "
                        "{} runs are less than three times that, so these runs cannot be ranked by accuracy.",
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
        result.notes.push_back(fmt::format(
            "Errors are measured on {} of the {} simulated strands, because the reference is slow.",
            result.strandsCompared, result.strands));
    }
    if (result.strands < result.groomStrands) {
        result.notes.push_back(
            fmt::format("Ran a sample of {} of {} strands (seed {}). Times are those of the sample.",
                        result.strands, result.groomStrands, result.options.seed));
    }
}

Status checkAxes(const WorkPrecisionOptions& options) {
    std::set<std::string> seen;
    for (const GridAxis& axis : options.axes) {
        if (auto status = checkAxis(axis); !status) return status;
        if (axis.field == kEngineAxis && !options.gpuEngine &&
            std::ranges::find(axis.values, 1.0) != axis.values.end())
            return fail("--engine gpu was requested, but there is no GPU", "expected cpu, or a GPU");
        if (!seen.insert(axis.field).second)
            return fail(axis.field + " is varied twice", "expected one list of values for it");
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
    // Guides stand for the strands around them: of a sample there would be too many.
    const bool all = findAxis(options.axes, kGuidesAxis).has_value();
    SceneHair sample = sampleStrands(groom, all ? groom.strandCount() : options.strands, options.seed);
    result.strands = sample.groom.strandCount();
    if (!(options.divergedAboveMm > 0)) result.options.divergedAboveMm = longestStrandMm(sample.groom) / 4;
    if (const auto points = findAxis(options.axes, kPointsAxis)) {
        result.groundTruthPoints = largestCount(options.axes[*points].values);
    }
    const auto made = GridHair::make(std::move(sample), result.options.axes, result.options.gpuEngine);
    if (!made) return tl::unexpected(made.error());
    const GridHair& hair = *made;

    // The truth counts as one run; it takes as long as several, but how many depends on the grid.
    Counted counted(options, 1 + result.runs.size() * (2 + options.repeats));
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
    if (auto status = findOtherErrors(hair, groom, poses, exact->followed.strands, result, counted); !status)
        return tl::unexpected(status.error());
    if (auto status = timeAll(hair, poses, result, counted); !status) return tl::unexpected(status.error());
    if (auto status = splitErrors(hair, groom, poses, *exact, result); !status)
        return tl::unexpected(status.error());
    if (!options.keepTrajectories) {
        for (WorkPrecisionRun& run : result.runs) run.trajectory = {};
    }
    noteWhatMatters(result);
    return result;
}

}  // namespace hairloom
