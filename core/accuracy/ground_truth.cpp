// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/ground_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hairloom {
namespace {

constexpr std::uint32_t kStepsPerFrame = 4;
constexpr std::uint32_t kFewestSubsteps = 4;
constexpr std::uint32_t kLengthIterations = 4;

/// An exact run has neither of these: sleep lets go of the motion, and few Newton steps of the length.
runtime::SimulationSettings converged(runtime::SimulationSettings settings, const SceneTime& time,
                                      std::uint32_t substeps) {
    settings.integrator = runtime::Integrator::verlet;
    const float partsPerSecond = time.framesPerSecond * static_cast<float>(time.stepsPerFrame);
    const float usual = std::ceil(static_cast<float>(substeps) * partsPerSecond * runtime::kUsualFrame);
    settings.substeps = std::min(static_cast<std::uint32_t>(usual), runtime::kMaxSubsteps);
    settings.sleepSpeed = 0;
    if (settings.lengthIterations > 0) settings.lengthIterations = kLengthIterations;
    return settings;
}

Result<Trajectory> run(SceneHair hair, std::span<const HeadPose> poses, const SceneTime& time,
                       const Followed& followed, std::uint32_t substeps) {
    hair.groom.simulation = converged(hair.groom.simulation, time, substeps);
    auto result = runScene(hair, poses, time, followed);
    if (!result) return tl::unexpected(result.error());
    if (!result->trajectory.finite) {
        return fail("the converged run is not finite", "expected a motion and a groom without NaN");
    }
    return std::move(result->trajectory);
}

}  // namespace

std::string EngineConverged::description() const {
    return fmt::format(
        "the engine itself (single precision; springs by position Verlet) with {} to {} substeps in each of "
        "{} parts of "
        "a "
        "frame, {} Newton steps for length and no sleep",
        2 * kFewestSubsteps, maxSubsteps_, kStepsPerFrame, kLengthIterations);
}

Result<GroundTruth> EngineConverged::compute(const SceneHair& hair, const HeadMotion& motion,
                                             const SceneTime& time, const Followed& followed) const {
    assert(maxSubsteps_ >= 2 * kFewestSubsteps);
    SceneTime fine = time;
    fine.stepsPerFrame = kStepsPerFrame;
    fine.posesWithin = 0;
    const std::vector<HeadPose> poses = posesOf(motion, fine);
    auto before = run(hair, poses, fine, followed, kFewestSubsteps);
    if (!before) return tl::unexpected(before.error());
    GroundTruth best;
    best.followed = followed;
    std::uint32_t bestSubsteps = 0;
    std::string changes;
    for (std::uint32_t substeps = 2 * kFewestSubsteps; substeps <= maxSubsteps_; substeps *= 2) {
        auto finer = run(hair, poses, fine, followed, substeps);
        if (!finer) return tl::unexpected(finer.error());
        const double change = compare(*before, *finer).rmsMm;
        changes += fmt::format("{}{:.3g} mm at {}", changes.empty() ? "" : ", ", change, substeps);
        if (bestSubsteps == 0 || change < best.uncertaintyMm) {
            best.trajectory = *finer;
            best.uncertaintyMm = change;
            bestSubsteps = substeps;
        }
        before = std::move(finer);
    }
    best.detail = fmt::format("{} substeps were taken; doubling changed {}", bestSubsteps, changes);
    const bool onlyWorse = bestSubsteps == 2 * kFewestSubsteps && maxSubsteps_ >= 4 * kFewestSubsteps;
    if (onlyWorse) best.detail += ". The engine does not converge in this scene";
    return best;
}

}  // namespace hairloom
