// SPDX-License-Identifier: GPL-3.0-or-later
// The reference's elastic rods against closed forms and against themselves.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/simulation/reference/converge.h"
#include "tests/simulation/elastica.h"
#include "tests/simulation/rod_fixture.h"

namespace hairloom {
namespace {

using namespace test;

/// Stiffness whose B is that.
float authoredOf(double B) {
    const double over = B / runtime::kHairBendingStiffness;
    return static_cast<float>(over / (1.0 + over));
}

/// Distance of the tip at rest from that of the elastica, as a share of the length. The held end is the
/// strand's root. The settings have the stiffness over `stiffer`, and the strand makes up for it.
double rodTipError(std::size_t segments, double stiffness, std::uint32_t clamped, double stiffer = 1.0) {
    constexpr double kLength = 0.2;
    runtime::SimulationSettings s = bareRods();
    s.clampedPoints = clamped;
    s.angularStiffness = authoredOf(stiffness / stiffer);
    reference::Strands strand = straightStrand(segments, kLength);
    strand.stiffness = {stiffer};
    reference::Solver solver = solverOf(strand, s);
    EXPECT_LT(comeToRest(solver), 1e-9);
    const double B = stiffer * reference::bendingStiffness(static_cast<double>(s.angularStiffness));
    const ElasticaShape right = solveElastica(B, kGravity, kLength);
    return (solver.positions_ws().back() - Vec3d(right.reach, -right.drop, 0.0)).norm() / kLength;
}

TEST(RodElastica, CantileverComesToRestOnIt) {
    for (const std::uint32_t clamped : {1u, 2u}) {
        std::printf("%u clamped: tip error, %% of the length\n%10s %10s %10s %10s %10s\n", clamped, "drop",
                    "8", "16", "32", "64");
        for (const double drop : {0.1, 0.4, 0.8}) {
            const double stiffness = elasticaStiffness(drop, kGravity, 0.2);
            std::vector<double> errors;
            for (const std::size_t segments : {8u, 16u, 32u, 64u})
                errors.push_back(rodTipError(segments, stiffness, clamped));
            std::printf("%9.0f%% %10.4f %10.4f %10.4f %10.4f\n", 100.0 * drop, 100.0 * errors[0],
                        100.0 * errors[1], 100.0 * errors[2], 100.0 * errors[3]);
            // Of second order, with the half segment beside the clamp counted in.
            EXPECT_LE(errors[2], 0.004);
            for (std::size_t i = 0; i + 1 < errors.size(); ++i) EXPECT_LT(errors[i + 1], 0.4 * errors[i]);
        }
    }
}

TEST(RodElastica, AStrandOfItsOwnStiffnessComesToRestOnThatOfItsOwn) {
    const double stiffness = elasticaStiffness(0.4, kGravity, 0.2);
    for (const double stiffer : {0.25, 4.0}) EXPECT_LE(rodTipError(32, stiffness, 2, stiffer), 0.004);
}

TEST(RodElastica, RefusesAStiffnessThatIsNone) {
    const auto errorOf = [](std::vector<double> stiffness) {
        reference::Strands strand = straightStrand(4, 0.2);
        strand.stiffness = std::move(stiffness);
        const auto made = reference::Solver::make(strand, bareRods());
        return made ? std::string() : made.error().message();
    };
    EXPECT_EQ(errorOf({2.0}), "");
    EXPECT_NE(errorOf({1.0, 1.0}).find("none or one per strand"), std::string::npos);
    EXPECT_NE(errorOf({-1.0}).find("0 or more"), std::string::npos);
    EXPECT_NE(errorOf({std::nan("")}).find("0 or more"), std::string::npos);
}

/// A single segment, so stiff that it turns a little only, swings with ω² = k/(m l²), on top of gravity.
TEST(RodPendulum, OneSegmentSwingsOnItsSpring) {
    runtime::SimulationSettings s = bareRods();
    s.clampedPoints = 1;
    s.gravity = {};
    s.angularStiffness = 0.5f;
    const double l = 0.1, B = reference::bendingStiffness(0.5);
    // B/(l/2) at the root, half of the hair's mass at the point.
    const double omega = std::sqrt(B / (0.5 * l) / (0.5 * l * l * l));
    const double small = 1e-4;
    reference::Solver solver = solverOf(straightStrand(1, l), s);
    const std::vector<Vec3d> start{Vec3d::Zero(), l * Vec3d(std::cos(small), std::sin(small), 0.0)};
    solver.setMotion(start, std::vector<Vec3d>(2, Vec3d::Zero()));
    solver.step(stillFrame(0.75 * kTau / omega), {400, 4});
    EXPECT_NEAR(solver.positions_ws()[1].y() / (l * small), 0.0, 1e-5);
    EXPECT_NEAR(solver.velocities_ws()[1].y() / (l * small * omega), 1.0, 1e-5);
    solver.step(stillFrame(0.25 * kTau / omega), {100, 4});
    EXPECT_NEAR(solver.positions_ws()[1].y() / (l * small), 1.0, 1e-5);
}

TEST(RodPendulum, HasTheEllipticPeriodWithoutStiffness) {
    runtime::SimulationSettings s = bareRods();
    s.clampedPoints = 1;
    s.angularStiffness = 0.0f;
    const double l = 0.25;
    for (const double angle : {0.1, 1.0, 3.0}) {
        const Vec3d direction(std::sin(angle), -std::cos(angle), 0.0);
        reference::Solver solver = solverOf(straightStrand(1, l, direction), s);
        const double period = kTau * std::sqrt(l / kGravity) / agm(1.0, std::cos(0.5 * angle));
        solver.step(stillFrame(0.5 * period), {400, 4});
        const Vec3d opposite(-direction.x() * l, direction.y() * l, 0.0);
        EXPECT_NEAR((solver.positions_ws()[1] - opposite).norm(), 0.0, 1e-8) << angle;
    }
}

TEST(RodEnergy, StaysWithoutDamping) {
    struct Case {
        const char* name;
        reference::Strands strands;
        float stiffness;
        std::uint32_t clamped;
    };
    const Case cases[] = {{"straight", straightStrand(12, 0.2), 0.3f, 2},
                          {"helix", helixStrand(24, 0.2, 0.008, 3.0), 0.3f, 2},
                          {"sprung helix", helixStrand(16, 0.2, 0.008, 2.0), 0.2f, 1}};
    for (const Case& each : cases) {
        runtime::SimulationSettings s = bareRods();
        s.angularStiffness = each.stiffness;
        s.clampedPoints = each.clamped;
        reference::Solver solver = solverOf(each.strands, s);
        const double before = solver.energy().total();
        double lowest = before, worst = 0.0;
        for (int frame = 0; frame < 30; ++frame) {
            EXPECT_EQ(solver.step(stillFrame(1.0 / 60.0), {64, 4}).failed, 0u);
            worst = std::max(worst, std::abs(solver.energy().total() - before));
            lowest = std::min(lowest, solver.energy().gravity - before);
        }
        std::printf("%s: energy off by %.2e of the fall\n", each.name, worst / -lowest);
        EXPECT_LT(worst, -1e-6 * lowest) << each.name;
    }
}

TEST(RodRest, NothingMovesWithoutLoad) {
    runtime::SimulationSettings s = bareRods();
    s.gravity = {};
    s.angularStiffness = 0.4f;
    for (const std::uint32_t clamped : {1u, 2u}) {
        s.clampedPoints = clamped;
        reference::Solver solver = solverOf(helixStrand(32, 0.2, 0.01, 3.0), s);
        const std::vector<Vec3d> rest = solver.positions_ws();
        for (int frame = 0; frame < 6; ++frame) solver.step(stillFrame(1.0 / 60.0), {8, 4});
        for (std::size_t p = 0; p < rest.size(); ++p)
            EXPECT_NEAR((solver.positions_ws()[p] - rest[p]).norm(), 0.0, 1e-12) << p;
    }
}

TEST(RodRest, GravityAtRestKeepsTheAuthoredShape) {
    runtime::SimulationSettings s = bareRods();
    s.angularStiffness = 0.9f;
    s.restGravity = 1.0f;
    for (const std::uint32_t clamped : {1u, 2u}) {
        s.clampedPoints = clamped;
        reference::Strands strands = helixStrand(24, 0.2, 0.008, 2.0);
        strands.rootRotations_ss = {
            reference::Quaterniond(Eigen::AngleAxisd(0.7, Vec3d(0.3, 0.2, 1.0).normalized()))};
        reference::Solver solver = solverOf(strands, s);
        const std::vector<Vec3d> rest = solver.positions_ws();
        EXPECT_GT(solver.energy().angular, 0.0);
        reference::Frame frame = stillFrame(0.1);
        frame.roots_ws = {{rest.front(), strands.rootRotations_ss.front()}};
        for (int i = 0; i < 5; ++i) EXPECT_EQ(solver.step(frame, {32, 4}).failed, 0u);
        for (std::size_t p = 0; p < rest.size(); ++p)
            EXPECT_NEAR((solver.positions_ws()[p] - rest[p]).norm(), 0.0, 1e-10) << p << ", " << clamped;
    }
}

/// Shaken and turned root, everything smooth on.
TEST(RodOrder, GrowsWithTheStages) {
    runtime::SimulationSettings s = bareRods();
    s.angularStiffness = 0.2f;
    s.dampingTime = 0.5f;
    s.bendDampingTime = 0.002f;
    s.airDrag = 2.0f;
    s.windSpeed = 2.0f;
    const reference::Strands strands = helixStrand(12, 0.15, 0.01, 1.0);
    std::vector<reference::Frame> frames;
    for (int i = 1; i <= 4; ++i) {
        reference::Frame frame = stillFrame(0.03, 0.03 * i);
        frame.roots_ws = {{Vec3d(0.005 * i, 0.0, 0.01 * i * i),
                           reference::Quaterniond(Eigen::AngleAxisd(0.25 * i, Vec3d::UnitY()))}};
        frames.push_back(frame);
    }
    const std::vector<reference::Root> start(1);
    for (const int order : {1, 2, 4}) {
        const auto result = reference::converged(strands, s, start, frames, {1e-9, 4, 256, order});
        ASSERT_TRUE(result) << result.error().message();
        EXPECT_EQ(result->report.failed, 0u);
        std::printf("order %d:", order);
        for (const double change : result->changes) std::printf(" %.1e", change);
        std::printf("\n");
        std::size_t n = result->changes.size();
        while (n > 2 && result->changes[n - 1] < 1e-9) --n;
        ASSERT_GE(n, 2u);
        const double measured = std::log2(result->changes[n - 2] / result->changes[n - 1]);
        std::printf("order %d measured as %.3f, last change %.1e m\n", order, measured, result->change);
        EXPECT_GT(measured, order - 0.25);
    }
}

}  // namespace
}  // namespace hairloom
