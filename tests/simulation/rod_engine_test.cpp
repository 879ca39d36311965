// SPDX-License-Identifier: GPL-3.0-or-later
// The engine's rods, in single precision with steps of one elimination each, converge to the reference's
// motion.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/simulation/reference/converge.h"
#include "tests/simulation/engine_run.h"
#include "tests/simulation/rod_fixture.h"

namespace hairloom {
namespace {

using namespace test;

constexpr std::uint32_t kSubsteps[] = {2, 4, 8, 16, 32};

/// Root mean square distances to the reference, mm, with kSubsteps.
std::vector<double> rodErrors(const Swing& scene, const runtime::SimulationSettings& s) {
    const reference::Root start;
    const auto right = reference::converged(scene.strands, s, {&start, 1}, scene.frames, {2e-6, 4, 256, 4});
    EXPECT_TRUE(right && right->report.failed == 0);
    EXPECT_TRUE(right->reached) << right->change;
    std::vector<double> errors;
    for (const std::uint32_t substeps : kSubsteps)
        errors.push_back(rmsMm(engineRun(scene, withSteps(s, runtime::Integrator::verlet, substeps)),
                               right->positions_ws));
    return errors;
}

/// Each halving of the step divides the error by `factor` or more, down to what single precision leaves.
void expectConvergence(const std::vector<double>& errors, double first, double factor) {
    constexpr double kSinglePrecision = 0.01;  // mm
    EXPECT_LT(errors.front(), first);
    for (std::size_t i = 1; i < errors.size(); ++i)
        EXPECT_LT(errors[i], std::max(errors[i - 1] / factor, kSinglePrecision))
            << kSubsteps[i] << " substeps";
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

TEST(RodsConverge, StraightHair) {
    expectConvergence(rodErrors(swing(straight(), 40), rods()), 0.7, 3.8);
}

TEST(RodsConverge, Helix) {
    expectConvergence(rodErrors(swing(helix(), 40), rods()), 0.7, 3.8);
}

TEST(RodsConverge, SoftHairThatCarriesItsWeight) {
    runtime::SimulationSettings soft = rods();
    soft.angularStiffness = 0.05f;
    soft.restGravity = 1.0f;
    expectConvergence(rodErrors(swing(curl(), 40), soft), 0.08, 2.4);
}

TEST(RodsConverge, StrandsOfTheirOwnStiffness) {
    for (const double stiffness : {0.25, 4.0}) {
        reference::Strands own = helix();
        own.stiffness = {stiffness};
        expectConvergence(rodErrors(swing(own, 40), rods()), 1.8, 2.4);
    }
}

TEST(RodsConverge, SprungRoot) {
    runtime::SimulationSettings sprung = rods();
    sprung.clampedPoints = 1;
    expectConvergence(rodErrors(swing(curl(), 40), sprung), 0.9, 3.4);
}

TEST(RodsConverge, FlatSections) {
    runtime::SimulationSettings flat = rods();
    flat.sectionRatio = 0.4f;
    expectConvergence(rodErrors(swing(straight(), 40), flat), 1.0, 3.0);
    expectConvergence(rodErrors(swing(helix(), 40), flat), 2.2, 2.9);
    flat.restGravity = 1.0f;
    expectConvergence(rodErrors(swing(curl(), 40), flat), 0.9, 3.0);
}

/// The angle of the air is that which the prediction has at the substep's end: of second order.
TEST(RodsConverge, Wind) {
    runtime::SimulationSettings windy = rods();
    windy.windSpeed = 4.0f;
    expectConvergence(rodErrors(swing(curl(), 40), windy), 2.0, 2.9);
}

/// A level strand falls on a capsule that lies across it, slanted and tapered, and moves.
Swing fallOnACapsule(std::size_t frames, bool joined) {
    Swing result{straightStrand(16, 0.2), {}};
    for (std::size_t f = 1; f <= frames; ++f) {
        const double t = static_cast<double>(f) * static_cast<double>(kFrameTime);
        reference::Frame frame{static_cast<double>(kFrameTime), t, {reference::Root{}}, {}};
        const double lift = 0.01 * std::sin(4.0 * t);
        frame.spheres = {{Vec3d(0.09, -0.08 + lift, -0.2), 0.05}, {Vec3d(0.13, -0.06, 0.15), 0.02}};
        if (joined) frame.capsules = {{0, 1}};
        result.frames.push_back(frame);
    }
    return result;
}

TEST(RodsConverge, OnACapsule) {
    runtime::SimulationSettings s = rods();
    s.angularStiffness = 0.3f;
    s.friction = 0.0f;
    s.collisionRadiusRoot = s.collisionRadiusTip = 0.0f;
    const Swing scene = fallOnACapsule(40, true);
    const reference::Root start;
    const auto right = reference::converged(scene.strands, s, {&start, 1}, scene.frames, {2e-5, 4, 256, 2});
    ASSERT_TRUE(right && right->report.failed == 0);
    EXPECT_GT(right->report.contacts, 0u);
    const auto errorOf = [&](const Swing& swing, std::uint32_t substeps) {
        return rmsMm(engineRun(swing, withSteps(s, runtime::Integrator::verlet, substeps)),
                     right->positions_ws);
    };
    EXPECT_GT(errorOf(fallOnACapsule(40, false), 16), 10.0) << "spheres alone miss it";
    const double two = errorOf(scene, 2), eight = errorOf(scene, 8), thirtyTwo = errorOf(scene, 32);
    EXPECT_LT(two, 4.0);
    EXPECT_LT(thirtyTwo, 1.0);
    EXPECT_LT(thirtyTwo, 0.7 * eight);
}

/// The tip of a rod lies on a bar and slides along it, where gravity leans by 0.48: friction holds up to 0.3.
Swing slideOnABar(std::size_t frames, std::vector<reference::Sphere> bar,
                  std::vector<std::array<std::size_t, 2>> capsules) {
    Swing result{straightStrand(1, 0.2), {}};
    for (std::size_t f = 1; f <= frames; ++f) {
        reference::Frame frame{static_cast<double>(kFrameTime),
                               static_cast<double>(f) * static_cast<double>(kFrameTime),
                               {reference::Root{}},
                               {}};
        frame.spheres = bar;
        frame.capsules = capsules;
        result.frames.push_back(frame);
    }
    return result;
}

TEST(RodsConverge, FrictionCountsOnceWhereCapsulesMeet) {
    runtime::SimulationSettings s = rods();
    s.clampedPoints = 1;
    s.angularStiffness = 1e-6f;
    s.dampingTime = s.bendDampingTime = s.airDrag = 0.0f;
    s.collisionRadiusRoot = s.collisionRadiusTip = 0.0f;
    s.friction = 0.3f;
    s.gravity = {0.0f, -9.0f, 9.0f * 0.48f};
    const Vec3d start(0.2, -0.05, -0.3), middle(0.2, -0.05, 0.0), end(0.2, -0.05, 0.3);
    const std::vector<reference::Sphere> ends{{start, 0.05}, {end, 0.05}},
        joined{{start, 0.05}, {middle, 0.05}, {end, 0.05}};
    const Swing one = slideOnABar(15, ends, {{0, 1}});
    const reference::Root root;
    const auto right = reference::converged(one.strands, s, {&root, 1}, one.frames, {2e-5, 4, 256, 2});
    ASSERT_TRUE(right && right->report.failed == 0);
    const double due = right->positions_ws.back().back().z();
    EXPECT_GT(due, 0.03);
    const auto slid = [&](const Swing& swing) {
        return engineRun(swing, withSteps(s, runtime::Integrator::verlet, 16)).back().back().z();
    };
    EXPECT_NEAR(slid(one), due, 0.05 * due);
    EXPECT_NEAR(slid(slideOnABar(15, joined, {{0, 1}, {1, 2}})), due, 0.05 * due);
    // The same bar twice, and the reference's own chain.
    EXPECT_NEAR(
        slid(slideOnABar(15, {{start, 0.05}, {end, 0.05}, {start, 0.05}, {end, 0.05}}, {{0, 1}, {2, 3}})),
        due, 0.05 * due);
    const auto chain = reference::converged(
        one.strands, s, {&root, 1}, slideOnABar(15, joined, {{0, 1}, {1, 2}}).frames, {2e-5, 4, 256, 2});
    ASSERT_TRUE(chain && chain->report.failed == 0);
    EXPECT_NEAR(chain->positions_ws.back().back().z(), due, 0.01 * due);
}

}  // namespace
}  // namespace hairloom
