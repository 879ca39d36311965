// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/truth.h"

#include <fmt/format.h>

namespace hairloom {
namespace {

constexpr std::uint32_t kStepsPerFrame = 4;
constexpr std::uint32_t kLengthIterations = 4;

/// An exact run has neither of these: sleep lets go of the motion, and few Newton steps of the length.
runtime::SimulationSettings converged(runtime::SimulationSettings settings, std::uint32_t substeps) {
    settings.integrator = runtime::Integrator::verlet;
    settings.substeps = substeps;
    settings.sleepSpeed = 0;
    if (settings.lengthIterations > 0) settings.lengthIterations = kLengthIterations;
    return settings;
}

Result<Trajectory> run(SceneHair hair, std::span<const HeadPose> poses, const SceneTime& time,
                       std::span<const float> shares, std::uint32_t substeps) {
    hair.groom.simulation = converged(hair.groom.simulation, substeps);
    auto result = runScene(hair, poses, time, shares);
    if (!result) return tl::unexpected(result.error());
    if (!result->trajectory.finite) {
        return fail("the converged run itself is not finite", "expected a motion and a groom without NaN");
    }
    return std::move(result->trajectory);
}

}  // namespace

std::string EngineConverged::description() const {
    return fmt::format(
        "the engine itself (single precision, position Verlet) with {} substeps in each of {} parts of a "
        "frame, "
        "{} Newton steps for length and no sleep",
        substeps_, kStepsPerFrame, kLengthIterations);
}

Result<Truth> EngineConverged::compute(const SceneHair& hair, const HeadMotion& motion, const SceneTime& time,
                                       std::span<const float> shares) const {
    SceneTime fine = time;
    fine.stepsPerFrame = kStepsPerFrame;
    const std::vector<HeadPose> poses = posesOf(motion, fine);
    auto trajectory = run(hair, poses, fine, shares, substeps_);
    if (!trajectory) return tl::unexpected(trajectory.error());
    const auto coarser = run(hair, poses, fine, shares, substeps_ / 2);
    if (!coarser) return tl::unexpected(coarser.error());
    const double uncertainty = compare(*coarser, *trajectory).rmsMm;
    return Truth{std::move(*trajectory), uncertainty};
}

}  // namespace hairloom
