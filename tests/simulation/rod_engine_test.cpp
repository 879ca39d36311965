// SPDX-License-Identifier: GPL-3.0-or-later
// The engine's rods, in single precision with steps of one elimination each, converge to the reference's
// motion.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "core/simulation/reference/converge.h"
#include "tests/simulation/engine_run.h"
#include "tests/simulation/rod_fixture.h"

namespace hairloom {
namespace {

using namespace test;

constexpr std::uint32_t kSubsteps[] = {2, 4, 8, 16, 32};

/// Root mean square distances to the reference, mm, with kSubsteps.
std::vector<double> rodErrors(const char* name, const Swing& scene, const runtime::SimulationSettings& s,
                              double tolerance = 2e-6) {
    const reference::Root start;
    const auto right =
        reference::converged(scene.strands, s, {&start, 1}, scene.frames, {tolerance, 4, 256, 4});
    EXPECT_TRUE(right && right->report.failed == 0);
    EXPECT_TRUE(right->reached) << name << ": " << right->change;
    std::vector<double> errors;
    for (const std::uint32_t substeps : kSubsteps)
        errors.push_back(rmsMm(engineRun(scene, withSteps(s, runtime::Integrator::verlet, substeps)),
                               right->positions_ws));
    std::printf("%s, substeps 2 to 32:", name);
    for (const double error : errors) std::printf(" %.4f", error);
    std::printf(" mm; reference %.1e m with %u substeps\n", right->change, right->substeps);
    return errors;
}

runtime::SimulationSettings rods() {
    runtime::SimulationSettings s;
    s.strandModel = runtime::StrandModel::rods;
    s.restGravity = 0.0f;
    return s;
}

reference::Strands straight() {
    return straightStrand(16, 0.2);
}
reference::Strands helix() {
    return helixStrand(32, 0.15, 0.008, 3.0);
}
reference::Strands curl() {
    return helixStrand(24, 0.2, 0.02, 1.0);
}

TEST(RodsConverge, ToTheReference) {
    rodErrors("straight", swing(straight(), 40), rods());
    rodErrors("helix", swing(helix(), 40), rods());
    runtime::SimulationSettings soft = rods();
    soft.angularStiffness = 0.05f;
    soft.restGravity = 1.0f;
    rodErrors("soft curl", swing(curl(), 40), soft);
    runtime::SimulationSettings sprung = rods();
    sprung.clampedPoints = 1;
    rodErrors("sprung root", swing(curl(), 40), sprung);
    runtime::SimulationSettings windy = rods();
    windy.windSpeed = 4.0f;
    rodErrors("wind", swing(curl(), 40), windy);
    runtime::SimulationSettings undamped = rods();
    undamped.bendDampingTime = 0.0f;
    undamped.dampingTime = 0.0f;
    undamped.airDrag = 0.0f;
    rodErrors("undamped", swing(curl(), 40), undamped);
    Swing ball = swing(straight(), 40);
    for (reference::Frame& frame : ball.frames) frame.spheres = {{Vec3d(0.08, -0.07, 0.005), 0.05}};
    rodErrors("sphere", ball, rods(), 1e-4);
}

}  // namespace
}  // namespace hairloom
