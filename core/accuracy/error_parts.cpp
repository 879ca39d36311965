// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/error_parts.h"

#include <algorithm>
#include <limits>

#include "hairloom/strands.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kFirstSubsteps = 4;

}  // namespace

ErrorSplitter::ErrorSplitter(const GridHair& hair, const std::vector<GridAxis>& axes,
                             const runtime::SimulationSettings& settings, std::span<const HeadPose> poses,
                             const SceneTime& time, const GroundTruth& exact)
    : hair_(hair),
      axes_(axes),
      settings_(settings),
      poses_(poses),
      framePoses_(framePosesOf(poses, time)),
      time_(time),
      exact_(exact) {}

Result<const ErrorSplitter::Converged*> ErrorSplitter::converged(const std::vector<double>& values,
                                                                 std::uint32_t points, bool rods) {
    if (const auto axis = findAxis(axes_, kPointsAxis); axis && points == 0)
        points = static_cast<std::uint32_t>(values[*axis]);
    std::vector<double> key = values;
    // What is the same for all of these.
    for (const std::string_view field :
         {std::string_view("substeps"), kThreadsAxis, kPointsAxis, kHairsPerGuideAxis}) {
        if (const auto axis = findAxis(axes_, field)) key[*axis] = 0;
    }
    key.push_back(points);
    key.push_back(rods);
    if (const auto found = made_.find(key); found != made_.end()) return &found->second;
    GridHair::Some some = hair_.alone(hair_.at(values, points), exact_.followed.strands, values);
    runtime::SimulationSettings& settings = some.hair.groom.simulation;
    if (rods) settings.strandModel = runtime::StrandModel::rods;
    // Beyond some step single precision rounds away what a shorter one gains: of these the run counts that is
    // nearest to the one before it.
    Converged best;
    best.trajectory.finite = false;
    best.doubt.rmsMm = std::numeric_limits<double>::infinity();
    Trajectory before;
    before.finite = false;
    for (std::uint32_t substeps = kFirstSubsteps; substeps <= kConvergedSubsteps; substeps *= 2) {
        settings.substeps = substeps;
        auto outcome = runScene(some.hair, poses_, hair_.timeAt(values, time_),
                                {some.strands, exact_.followed.shares}, hair_.optionsAt(values));
        if (!outcome) return tl::unexpected(outcome.error());
        Trajectory& now = outcome->trajectory;
        if (now.finite && before.finite) {
            const TrajectoryError change = compare(before, now);
            if (change.rmsMm < best.doubt.rmsMm) best = {now, change};
        }
        before = std::move(now);
    }
    hair_.moveToOwnRoots(values, exact_.followed, framePoses_, best.trajectory);
    return &made_.emplace(std::move(key), std::move(best)).first->second;
}

Result<std::optional<ErrorParts>> ErrorSplitter::split(const WorkPrecisionRun& run) {
    const std::uint32_t exactPoints = findAxis(axes_, kPointsAxis) ? hair_.finestPoints() : 0;
    const std::uint32_t twice = std::min(2 * hair_.finestPoints(), runtime::kMaxPoints);
    const bool isRod = settings_.strandModel == runtime::StrandModel::rods;
    const auto own = converged(run.values, 0, false);
    if (!own) return tl::unexpected(own.error());
    const auto finer = converged(run.values, twice, false);
    if (!finer) return tl::unexpected(finer.error());
    const auto model = converged(run.values, exactPoints, false);
    if (!model) return tl::unexpected(model.error());
    const Trajectory* rod = &exact_.trajectory;
    if (!isRod) {
        const auto rods = converged(run.values, exactPoints, true);
        if (!rods) return tl::unexpected(rods.error());
        rod = &(*rods)->trajectory;
    }
    for (const Trajectory* each : {&(*own)->trajectory, &(*finer)->trajectory, &(*model)->trajectory, rod}) {
        if (!each->finite) return std::nullopt;
    }
    ErrorParts parts{compare(run.trajectory, (*own)->trajectory),
                     compare((*own)->trajectory, (*finer)->trajectory), compare((*model)->trajectory, *rod)};
    // No nearer than what it is compared with is known.
    parts.step.rmsMm = std::max(parts.step.rmsMm, (*own)->doubt.rmsMm);
    parts.step.maxMm = std::max(parts.step.maxMm, (*own)->doubt.maxMm);
    return parts;
}

}  // namespace hairloom
