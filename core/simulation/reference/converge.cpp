// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/converge.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace hairloom::reference {
namespace {

/// Of a run that has failed somewhere, and that counts as not converged whatever comes.
constexpr int kHalvingsOnceFailed = 1;

Status runFrames(Solver solver, std::span<const Root> start, std::span<const Frame> frames,
                 StepOptions options, const Goal& goal, Convergence& result) {
    solver.reset(start);
    result.report = {};
    result.positions_ws.clear();
    for (const Frame& frame : frames) {
        if (goal.cancelled && goal.cancelled())
            return fail("the reference was cancelled", "expected it to run to its end");
        if (result.report.failed > 0) options.halvings = kHalvingsOnceFailed;
        const StepReport report = solver.step(frame, options);
        result.report.steps += report.steps;
        result.report.halved += report.halved;
        result.report.failed += report.failed;
        result.report.contacts += report.contacts;
        result.report.largestStretch = std::max(result.report.largestStretch, report.largestStretch);
        result.report.deepestPenetration =
            std::max(result.report.deepestPenetration, report.deepestPenetration);
        result.report.fastestApproach = std::max(result.report.fastestApproach, report.fastestApproach);
        result.positions_ws.push_back(solver.positions_ws());
        const auto& last = result.positions_ws.back();
        if (std::ranges::all_of(last, [](const Vec3d& x) { return x.allFinite(); })) continue;
        // Nothing but the same comes of points that are no numbers, and slowly.
        result.positions_ws.resize(frames.size(), std::vector<Vec3d>(last));
        break;
    }
    result.velocities_ws = solver.velocities_ws();
    result.substeps = options.substeps;
    return {};
}

/// Infinite where a point is no number.
double largestDistance(const std::vector<std::vector<Vec3d>>& a, const std::vector<std::vector<Vec3d>>& b) {
    double largest = 0.0;
    for (std::size_t f = 0; f < a.size(); ++f) {
        for (std::size_t p = 0; p < a[f].size(); ++p) {
            const double distance = (a[f][p] - b[f][p]).norm();
            if (!(distance < std::numeric_limits<double>::max()))
                return std::numeric_limits<double>::infinity();
            largest = std::max(largest, distance);
        }
    }
    return largest;
}

}  // namespace

Result<Convergence> converged(const Strands& strands, const runtime::SimulationSettings& settings,
                              std::span<const Root> start, std::span<const Frame> frames, const Goal& goal,
                              BendingForce bendingForce) {
    const Result<Solver> solver = Solver::make(strands, settings, bendingForce);
    if (!solver) return tl::unexpected(solver.error());
    Convergence result;
    result.change = std::numeric_limits<double>::infinity();
    if (auto run = runFrames(*solver, start, frames, {goal.firstSubsteps, goal.order}, goal, result); !run)
        return tl::unexpected(run.error());
    while (!result.reached && result.substeps <= goal.maxSubsteps / 2) {
        result.coarser_ws = std::move(result.positions_ws);
        const StepOptions finer{2 * result.substeps, goal.order};
        if (auto run = runFrames(*solver, start, frames, finer, goal, result); !run)
            return tl::unexpected(run.error());
        result.change = largestDistance(result.coarser_ws, result.positions_ws);
        result.changes.push_back(result.change);
        result.reached = result.change <= goal.tolerance && result.report.failed == 0;
    }
    return result;
}

}  // namespace hairloom::reference
