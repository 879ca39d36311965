// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/error_parts.h"

#include <algorithm>

#include "hairloom/strands.h"

namespace hairloom {

ErrorSplitter::ErrorSplitter(const GridHair& hair, const std::vector<GridAxis>& axes,
                             const runtime::SimulationSettings& settings, std::span<const HeadPose> poses,
                             const SceneTime& time, const GroundTruth& exact)
    : hair_(hair), axes_(axes), settings_(settings), poses_(poses), time_(time), exact_(exact) {}

Result<const Trajectory*> ErrorSplitter::converged(const std::vector<double>& values, std::uint32_t points,
                                                   bool rods) {
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
    settings.substeps = std::max(settings.substeps, kConvergedSubsteps);
    if (rods) settings.strandModel = runtime::StrandModel::rods;
    auto outcome =
        runScene(some.hair, poses_, time_, {some.strands, exact_.followed.shares}, hair_.optionsAt(values));
    if (!outcome) return tl::unexpected(outcome.error());
    hair_.moveToOwnRoots(values, exact_.followed, poses_, outcome->trajectory);
    return &made_.emplace(std::move(key), std::move(outcome->trajectory)).first->second;
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
        rod = *rods;
    }
    if (!(*own)->finite || !(*finer)->finite || !(*model)->finite || !rod->finite) return std::nullopt;
    return ErrorParts{compare(run.trajectory, **own), compare(**own, **finer), compare(**model, *rod)};
}

}  // namespace hairloom
