// SPDX-License-Identifier: GPL-3.0-or-later
// The engine, in single precision and one step after the other, converges to the reference's motion.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/simulation/reference/converge.h"
#include "tests/simulation/engine_run.h"
#include "tests/support/spring_settings.h"

namespace hairloom {
namespace {

using namespace test;
using runtime::Integrator;

std::vector<std::vector<Vec3d>> groundTruthOf(const Swing& swing, const runtime::SimulationSettings& s) {
    const reference::Root start;
    const reference::Goal goal{1e-6, 4, 256, 4};
    const auto result = reference::converged(swing.strands, s, {&start, 1}, swing.frames, goal);
    EXPECT_TRUE(result.has_value() && result->reached);
    return result->positions_ws;
}

/// Millimetres from the truth, at substeps from 2 doubled up to `most`.
std::vector<double> errorsOf(const Swing& swing, const runtime::SimulationSettings& s, Integrator integrator,
                             std::uint32_t maximum) {
    const auto groundTruth = groundTruthOf(swing, s);
    std::vector<double> errors;
    for (std::uint32_t substeps = 2; substeps <= maximum; substeps *= 2)
        errors.push_back(rmsMm(engineRun(swing, withSteps(s, integrator, substeps)), groundTruth));
    std::printf("%s, substeps 2 to %u:", nameOf(integrator), maximum);
    for (const double error : errors) std::printf(" %.3g", error);
    std::printf(" mm\n");
    return errors;
}

/// Hair of 25 cm that starts level: it falls, swings and lashes.
reference::Strands straight() {
    return straightStrand(12, 0.25);
}
reference::Strands wavy() {
    return helixStrand(12, 0.25, 0.01, 1.0);
}

TEST(EngineConverges, ChainsInAllIntegrators) {
    // With lengths held as constraints no method is of a higher order than 2. Those that give the air a
    // velocity from before the kick are of order 1.
    runtime::SimulationSettings s = bareSettings();
    s.airDrag = 2.0f;
    s.dampingTime = 0.5f;
    const Swing scene = swing(straight(), 60);
    const auto secondOrder = {Integrator::velocityVerlet, Integrator::rk4};
    for (const Integrator integrator : secondOrder) {
        const auto errors = errorsOf(scene, s, integrator, 16);
        EXPECT_GT(errors[0] / errors[2], 9.0) << "order 2 is 16 from 2 to 8 substeps";
        EXPECT_LT(errors[3], 0.2) << "single precision ends it";
    }
    for (const Integrator integrator : {Integrator::verlet, Integrator::explicitEuler}) {
        const auto errors = errorsOf(scene, s, integrator, 16);
        EXPECT_GT(errors[0] / errors[3], 7.0) << "order 1 is 8 from 2 to 16 substeps";
        EXPECT_LT(errors[3], 1.0);
    }
    // Their tension acts along the segments as they are after the step, which damps.
    for (const Integrator integrator : {Integrator::leapfrog, Integrator::implicitEuler}) {
        const auto errors = errorsOf(scene, s, integrator, 16);
        EXPECT_GT(errors[0] / errors[3], 3.5);
        EXPECT_LT(errors[3], 4.0);
    }
}

TEST(EngineConverges, StraightRodsWithoutBendDamping) {
    runtime::SimulationSettings s = runtime::springSettings();
    s.bendDampingTime = 0.0f;
    const Swing scene = swing(straight(), 60);
    const auto verlet = errorsOf(scene, s, Integrator::verlet, 32);
    EXPECT_GT(verlet[1] / verlet[3], 3.0) << "order 1 is 4 from 4 to 16 substeps";
    EXPECT_LT(verlet[4], 0.5);
    const auto explicitly = errorsOf(scene, s, Integrator::velocityVerlet, 16);
    EXPECT_GT(explicitly[0] / explicitly[2], 16.0);
    EXPECT_LT(explicitly[3], 0.1);
}

TEST(EngineConverges, TheDefaultMethodWithBendDamping) {
    // Damping of bending and the constraint of length are solved one after the other, which lets the order
    // come down to 1 only where h is well below bendDampingTime.
    for (const auto& strands : {straight(), wavy()}) {
        const auto errors = errorsOf(swing(strands, 60), runtime::springSettings(), Integrator::verlet, 64);
        for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i], errors[i - 1]) << i;
        EXPECT_LT(errors[2], 1.6)
            << "8 substeps, the default; 3.5 without the tension in the step of bending";
        EXPECT_LT(errors.back(), 0.35 * errors[1]);
    }
}

TEST(EngineConverges, HairWhoseStiffnessFollowsACurve) {
    runtime::SimulationSettings s = runtime::springSettings();
    s.angularStiffness = 0.6f;
    const runtime::Ramp::Key keys[] = {{0, 0.3f}, {0.3f, 1}, {0.5f, 0.1f}, {1, 0.6f}};
    s.angularCurve = runtime::Ramp::of(keys);
    const Swing scene = swing(straight(), 60);
    const auto errors = errorsOf(scene, s, Integrator::verlet, 64);
    for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i], errors[i - 1]) << i;
    EXPECT_LT(errors.back(), 0.35 * errors[1]);
    // The truth of another curve is farther away than the error.
    runtime::SimulationSettings even = s;
    even.angularCurve = {};
    EXPECT_GT(rmsMm(groundTruthOf(scene, s), groundTruthOf(scene, even)), 5 * errors.back());
}

TEST(EngineConverges, OnlyPositionVerletDampsBending) {
    const Swing scene = swing(straight(), 60);
    runtime::SimulationSettings s = runtime::springSettings();
    const double damped = errorsOf(scene, s, Integrator::velocityVerlet, 16).back();
    s.bendDampingTime = 0.0f;
    const double undamped = errorsOf(scene, s, Integrator::velocityVerlet, 16).back();
    EXPECT_GT(damped, 20.0 * undamped);
}

}  // namespace
}  // namespace hairloom
