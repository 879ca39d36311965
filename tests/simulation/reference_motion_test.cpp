// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of the reference against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/simulation/reference/converge.h"
#include "core/simulation/reference/forces.h"
#include "hairloom/engine.h"
#include "tests/simulation/reference_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom {
namespace {

using namespace test;

TEST(ReferencePendulum, SwingsWithTheEllipticPeriod) {
    // T = 2π √(l/g) / agm(1, cos(θ₀/2)), from rest at θ₀.
    const double l = 0.25;
    for (const double angle : {0.1, 1.0, 2.0, 3.0}) {
        const Vec3d direction(std::sin(angle), -std::cos(angle), 0.0);
        reference::Solver solver = solverOf(straightStrand(1, l, direction), bareSettings());
        const double period = kTau * std::sqrt(l / kGravity) / agm(1.0, std::cos(0.5 * angle));
        solver.step(stillFrame(0.5 * period), {400, 4});
        const Vec3d opposite(-direction.x() * l, direction.y() * l, 0.0);
        EXPECT_NEAR((solver.positions_ws()[1] - opposite).norm(), 0.0, 1e-9) << angle;
        const reference::StepReport report = solver.step(stillFrame(0.5 * period), {400, 4});
        EXPECT_NEAR((solver.positions_ws()[1] - direction * l).norm(), 0.0, 1e-9) << angle;
        EXPECT_LT(report.largestStretch, 1e-12);
        EXPECT_EQ(report.failed, 0u);
    }
}

TEST(ReferencePendulum, TwoEqualMassesHaveTheirNormalModes) {
    // ω² = (2 ± √2) g/l for small swings, angles 1 : ∓√2.
    const double l = 0.2, small = 1e-5;
    for (const double sign : {-1.0, 1.0}) {
        reference::Strands strands = straightStrand(2, 2.0 * l, -Vec3d::UnitY());
        strands.pointMasses = {1.0, 1.0, 1.0};
        reference::Solver solver = solverOf(strands, bareSettings());
        const double first = small,
                     second = (1.0 - sign * std::sqrt(2.0)) * small;  // across, of points 1 and 2
        const auto below = [&](double across) { return -std::sqrt(l * l - across * across); };
        const Vec3d one(first, below(first), 0.0);
        const Vec3d two = one + Vec3d(second - first, below(second - first), 0.0);
        const std::vector<Vec3d> start{Vec3d::Zero(), one, two}, still(3, Vec3d::Zero());
        solver.setMotion(start, still);
        const double period = kTau / std::sqrt((2.0 + sign * std::sqrt(2.0)) * kGravity / l);
        solver.step(stillFrame(0.5 * period), {200, 4});
        EXPECT_NEAR(solver.positions_ws()[1].x() / -first, 1.0, 1e-6);
        EXPECT_NEAR(solver.positions_ws()[2].x() / -second, 1.0, 1e-6);
    }
}

TEST(ReferenceChain, ConservesEnergyOverTenSeconds) {
    reference::Solver solver = solverOf(straightStrand(8, 0.3), bareSettings());
    const double before = solver.energy().total();
    double lowest = 0.0, worst = 0.0, stretch = 0.0;
    std::uint64_t failed = 0;
    for (int frame = 0; frame < 600; ++frame) {
        const reference::StepReport report = solver.step(stillFrame(1.0 / 60.0), {48, 4});
        const reference::Energy now = solver.energy();
        worst = std::max(worst, std::abs(now.total() - before));
        lowest = std::min(lowest, now.gravity);
        stretch = std::max(stretch, report.largestStretch);
        failed += report.failed;
    }
    std::printf("energy off by %.2e of the fall\n", worst / (before - lowest));
    EXPECT_LT(worst, 1e-6 * (before - lowest));
    EXPECT_LT(stretch, 1e-12);
    EXPECT_EQ(failed, 0u);
}

TEST(ReferenceChain, ConservesEnergyWithStiffStraightRods) {
    for (const auto method : {runtime::AngularMethod::smallAngle, runtime::AngularMethod::exact}) {
        runtime::SimulationSettings s = bareSettings();
        s.clampedPoints = 2;
        s.angularStiffness = 0.5f;
        s.angularMethod = method;
        reference::Solver solver = solverOf(straightStrand(12, 0.2), s);
        const double before = solver.energy().total();
        double lowest = 0.0, worst = 0.0;
        for (int frame = 0; frame < 60; ++frame) {
            EXPECT_EQ(solver.step(stillFrame(1.0 / 60.0), {32, 4}).failed, 0u);
            worst = std::max(worst, std::abs(solver.energy().total() - before));
            lowest = std::min(lowest, solver.energy().gravity);
        }
        std::printf("energy off by %.2e of the fall\n", worst / (before - lowest));
        EXPECT_LT(worst, 1e-6 * (before - lowest));
    }
}

/// Largest gain of energy within half a second, as a share of that of the push.
double gainOfCurl(reference::BendingForce bendingForce) {
    runtime::SimulationSettings s = bareSettings();
    s.clampedPoints = 2;
    s.angularStiffness = 0.3f;
    s.angularMethod = runtime::AngularMethod::exact;
    reference::Solver solver = solverOf(helixStrand(16, 0.2, 0.005, 4.0), s, bendingForce);
    std::vector<Vec3d> push(17, Vec3d::Zero());
    for (std::size_t p = 0; p < push.size(); ++p) push[p].z() = 0.5 * static_cast<double>(p) / 16.0;
    solver.setMotion(solver.positions_ws(), push);
    const double before = solver.energy().total(), pushed = solver.energy().kinetic;
    double gain = 0.0;
    for (int frame = 0; frame < 10; ++frame) {
        EXPECT_EQ(solver.step(stillFrame(1.0 / 60.0), {64, 4}).failed, 0u);
        gain = std::max(gain, std::abs(solver.energy().total() - before));
    }
    return gain / pushed;
}

TEST(ReferenceChain, ConservesEnergyOfCurlsOnlyWithTheWholeGradient) {
    EXPECT_LT(gainOfCurl(reference::BendingForce::gradient), 1e-5);
    // Held frames are a flaw of the model, not of the steps: it does not fade with more of them.
    EXPECT_GT(gainOfCurl(reference::BendingForce::framesHeld), 0.1);
}

TEST(ReferenceCoil, SwingsAtItsFrequencyAndHangsByItsStretch) {
    runtime::SimulationSettings s = bareSettings();
    s.lengthMethod = runtime::LengthMethod::springs;
    s.springFrequency = 25.0f;
    s.gravity = {0.0f, 0.0f, 0.0f};
    const double l = 0.1, stretch = 0.02, period = 1.0 / 25.0;
    reference::Solver solver = solverOf(straightStrand(1, l), s);
    const std::vector<Vec3d> start{Vec3d::Zero(), Vec3d(l + stretch, 0, 0)}, still(2, Vec3d::Zero());
    for (int eighth = 1; eighth <= 16; ++eighth) {
        solver.setMotion(start, still);
        solver.step(stillFrame(period * eighth / 8.0), {512, 4});
        EXPECT_NEAR(solver.positions_ws()[1].x(), l + stretch * std::cos(kTau * eighth / 8.0), 1e-8);
    }
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.dampingTime = 0.02f;
    reference::Solver hanging = solverOf(straightStrand(1, l, -Vec3d::UnitY()), s);
    hanging.step(stillFrame(1.5), {2000, 2});
    EXPECT_NEAR(hanging.positions_ws()[1].y(), -l - kGravity / std::pow(kTau * 25.0, 2), 1e-10);
}

TEST(ReferenceAir, FreeFallReachesTheTerminalSpeed) {
    // Strand and root fall alike, broadside to the air: v = −(g/c)(1 − e^{−ct}).
    runtime::SimulationSettings s = bareSettings();
    s.lengthIterations = 0;
    s.airDrag = 4.0f;
    const double c = 4.0, frameTime = 1e-3;
    reference::Solver solver = solverOf(straightStrand(2, 0.2), s);
    const auto fallen = [&](double t) { return -kGravity / c * (t - (1.0 - std::exp(-c * t)) / c); };
    double t = 0.0;
    for (int frame = 0; frame < 3000; ++frame) {
        t += frameTime;
        reference::Frame input = stillFrame(frameTime, t);
        input.roots_ws[0].position.y() = fallen(t);
        solver.step(input, {1, 2});
    }
    EXPECT_NEAR(solver.positions_ws()[2].y(), fallen(t), 1e-5);
    EXPECT_NEAR(solver.velocities_ws()[2].y(), -kGravity / c * (1.0 - std::exp(-c * t)), 1e-5);
    EXPECT_NEAR(solver.velocities_ws()[2].y(), -kGravity / c, 2e-5);
}

TEST(ReferenceAir, WindAlongTheStrandDoesNotPushIt) {
    runtime::SimulationSettings s = bareSettings();
    s.lengthIterations = 0;
    s.airDrag = 4.0f;
    s.gravity = {0.0f, 0.0f, 0.0f};
    s.windSpeed = 3.0f;
    s.windGustiness = 0.0f;
    for (const double angle : {0.0, 0.5, 1.5}) {
        reference::Solver solver = solverOf(straightStrand(1, 0.5, {std::cos(angle), std::sin(angle), 0}), s);
        const double t = 1e-4;
        solver.step(stillFrame(t), {4, 2});
        EXPECT_NEAR(solver.velocities_ws()[1].x() / t, 4.0 * std::sin(angle) * 3.0, 0.01) << angle;
    }
}

TEST(ReferenceAir, GustsAreTheWavesOfTheWind) {
    runtime::SimulationSettings s = bareSettings();
    s.airDrag = 2.0f;
    s.windSpeed = 3.0f;
    s.windGustiness = 0.5f;
    const reference::Physics physics(s);
    // At its time and position a wave moves with its phase speed.
    const runtime::Wind wind = runtime::makeWind(s);
    const Vec3d position(0.3, 1.2, -0.4);
    for (const double time : {0.0, 0.7, 31.0}) {
        const auto phases = runtime::windPhases(wind, time);
        Vec3d sum(static_cast<double>(wind.mean.x), static_cast<double>(wind.mean.y),
                  static_cast<double>(wind.mean.z));
        for (std::size_t m = 0; m < phases.size(); ++m) {
            const auto& mode = wind.modes[m];
            const auto& k = mode.waveVector;
            const double turns = static_cast<double>(phases[m]) + static_cast<double>(k.x) * position.x() +
                                 static_cast<double>(k.y) * position.y() +
                                 static_cast<double>(k.z) * position.z();
            const double wave = std::sin(kTau * turns);
            sum += wave * Vec3d(static_cast<double>(mode.amplitude.x), static_cast<double>(mode.amplitude.y),
                                static_cast<double>(mode.amplitude.z));
        }
        EXPECT_NEAR((reference::airVelocity(physics, position, time) - sum).norm(), 0.0, 1e-5);
    }
}

/// What the engine's strands are told of the air at a position is what the reference has there, for every
/// kind.
TEST(ReferenceAir, EveryKindOfWindIsTheEngines) {
    for (const runtime::WindKind kind : {runtime::WindKind::uniform, runtime::WindKind::gusting,
                                         runtime::WindKind::turbulent, runtime::WindKind::vehicle}) {
        runtime::SimulationSettings s = bareSettings();
        s.airDrag = 1000.0f;  // hair has the speed of the air at once
        s.windKind = kind;
        s.windSpeed = 4.0f;
        s.windGustiness = 0.8f;
        s.windFrequency = 1.0f;
        s.windGustSize = 5.0f;
        s.gravity = {};
        s.dampingTime = 0.0f;
        s.lengthIterations = 0;
        s.substeps = 64;
        const std::vector<runtime::Float3> points{{0.1f, 0.2f, 0.3f}, {0.1f, 0.9f, 1.0f}};
        const std::vector<std::uint32_t> offsets{0, 2};
        auto made = runtime::Engine::make({offsets, points}, s);
        ASSERT_TRUE(made.engine) << made.error;
        const std::vector<runtime::RootFrame> roots{{points[0], {}}};
        for (const double time : {0.4, 1.7}) {
            runtime::FrameInput input;
            input.dt = 0.008f;
            input.time = time;
            input.roots_ws = roots;
            input.actorVelocity_ws = {0.0f, 0.0f, 1.5f};
            made.engine->reset(roots);
            made.engine->step(input);
            std::vector<runtime::Float3> speeds(2);
            made.engine->readVelocities(speeds);
            const Vec3d engine(static_cast<double>(speeds[1].x), static_cast<double>(speeds[1].y),
                               static_cast<double>(speeds[1].z));
            reference::Physics physics(s);
            physics.takeWind(s, {{}, input.actorVelocity_ws});
            const Vec3d air = reference::airVelocity(physics, Vec3d(0.1, 0.9, 1.0), time);
            EXPECT_GT(air.norm(), 0.5);
            // Hair lags a millisecond behind.
            EXPECT_NEAR((engine - air).norm() / air.norm(), 0.0, 0.02)
                << static_cast<int>(kind) << " at " << time;
        }
    }
}

TEST(ReferenceAir, AFramesWindTakesThePlaceOfTheSettings) {
    runtime::SimulationSettings s = bareSettings();
    s.airDrag = 2.0f;
    s.windKind = runtime::WindKind::uniform;
    reference::Solver solver = solverOf(straightStrand(1, 0.1), s);
    reference::Frame frame = stillFrame(0.001);
    solver.step(frame);
    const double still = solver.velocities_ws()[1].z();
    frame.wind.mean_ws = runtime::Float3{0.0f, 0.0f, 5.0f};
    solver.step(frame);
    EXPECT_EQ(still, 0.0);
    EXPECT_NEAR(solver.velocities_ws()[1].z(), 2.0 * 5.0 * 0.001, 1e-4);
}

TEST(ReferenceDamping, MotionRelativeToTheRootDecays) {
    runtime::SimulationSettings s = bareSettings();
    s.lengthIterations = 0;
    s.dampingTime = 0.25f;
    s.gravity = {0.0f, 0.0f, 0.0f};
    reference::Solver solver = solverOf(straightStrand(1, 0.1), s);
    reference::Frame frame = stillFrame(0.5);
    frame.roots_ws[0].position = Vec3d(1.0, 0.0, 0.0);  // 2 m/s
    const Vec3d relative(0.3, -1.0, 0.5), root(2.0, 0.0, 0.0);
    const std::vector<Vec3d> speeds{root, root + relative};
    solver.setMotion(solver.positions_ws(), speeds);
    solver.step(frame, {64, 4});
    EXPECT_NEAR((solver.velocities_ws()[1] - root - relative * std::exp(-2.0)).norm(), 0.0, 1e-7);
}

TEST(ReferenceRoot, StiffStrandFollowsATurningRootAndATeleport) {
    runtime::SimulationSettings s = bareSettings();
    s.clampedPoints = 2;
    reference::Strands strands = straightStrand(4, 0.2);
    reference::Solver solver = solverOf(strands, s);
    reference::Frame frame = stillFrame(0.02);
    const reference::Quaterniond turned(Eigen::AngleAxisd(0.6, Vec3d(0.2, 1.0, -0.5).normalized()));
    frame.roots_ws = {{Vec3d(0.1, 0.05, 0.0), turned}};
    solver.step(frame, {32, 4});
    const std::vector<Vec3d> x = solver.positions_ws();
    EXPECT_NEAR((x[0] - Vec3d(0.1, 0.05, 0.0)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((x[1] - x[0] - turned * Vec3d(0.05, 0, 0)).norm(), 0.0, 1e-15);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR((x[j + 1] - x[j]).norm(), 0.05, 1e-13);

    // A cut: the same shape and speeds, turned, but for what gravity does in a microsecond.
    const std::vector<Vec3d> v = solver.velocities_ws();
    const reference::Quaterniond cut(Eigen::AngleAxisd(1.0, Vec3d::UnitZ()));
    frame.dt = 1e-6;
    frame.roots_ws = {{Vec3d(5.0, 0.0, 0.0), cut * turned}};
    solver.step(frame, {1, 2});
    for (std::size_t p = 0; p <= 4; ++p)
        EXPECT_NEAR((solver.positions_ws()[p] - Vec3d(5, 0, 0) - cut * (x[p] - x[0])).norm(), 0.0, 1e-4);
    EXPECT_GT(v[4].norm(), 0.1);
}

/// Shaken root, bent strand, everything smooth on.
TEST(ReferenceOrder, IsTwoAndFour) {
    runtime::SimulationSettings s = bareSettings();
    s.clampedPoints = 2;
    s.angularStiffness = 0.2f;
    s.dampingTime = 0.5f;
    s.bendDampingTime = 0.002f;
    s.airDrag = 2.0f;
    s.windSpeed = 2.0f;
    reference::Strands strands = straightStrand(5, 0.2, Vec3d(1.0, 0.5, 0.2).normalized());
    strands.restPositions_ss[3] += Vec3d(0.0, 0.01, 0.02);
    strands.restPositions_ss[5] += Vec3d(0.0, 0.01, -0.02);
    std::vector<reference::Frame> frames;
    for (int i = 1; i <= 4; ++i) {
        reference::Frame frame = stillFrame(0.06, 0.06 * i);
        frame.roots_ws = {{Vec3d(0.01 * i, 0.0, 0.02 * i * i),
                           reference::Quaterniond(Eigen::AngleAxisd(0.5 * i, Vec3d::UnitY()))}};
        frames.push_back(frame);
    }
    const std::vector<reference::Root> start(1);
    for (const int order : {2, 4}) {
        const auto result = reference::converged(strands, s, start, frames, {1e-12, 4, 256, order});
        ASSERT_TRUE(result) << result.error().message();
        EXPECT_EQ(result->report.failed, 0u);
        std::size_t n = result->changes.size();
        // Close to rounding the last changes say nothing about the order.
        while (n > 2 && result->changes[n - 1] < 1e-10) --n;
        ASSERT_GE(n, 2u);
        const double measured = std::log2(result->changes[n - 2] / result->changes[n - 1]);
        std::printf("order %d measured as %.3f, last change %.1e m\n", order, measured, result->change);
        EXPECT_GT(measured, order - 0.25);
    }
}

TEST(ReferenceConverged, SaysHowFarItGot) {
    const std::vector<reference::Root> start(1);
    const std::vector<reference::Frame> frames{stillFrame(0.2)};
    const reference::Strands strands = straightStrand(4, 0.2);
    const auto good = reference::converged(strands, bareSettings(), start, frames, {1e-8, 4, 1024, 4});
    ASSERT_TRUE(good);
    EXPECT_TRUE(good->reached);
    EXPECT_LE(good->change, 1e-8);
    EXPECT_LT(good->substeps, 1024u);
    const auto bad = reference::converged(strands, bareSettings(), start, frames, {1e-15, 4, 16, 2});
    ASSERT_TRUE(bad);
    EXPECT_FALSE(bad->reached);
    EXPECT_EQ(bad->substeps, 16u);
    EXPECT_GT(bad->change, 1e-15);
    EXPECT_EQ(bad->changes.size(), 2u);
}

TEST(ReferenceMake, RefusesUnsupportedSettings) {
    runtime::SimulationSettings s = runtime::springSettings();
    EXPECT_TRUE(reference::Solver::make(straightStrand(3, 0.1), s));
    EXPECT_FALSE(reference::Solver::make(straightStrand(3, 0.0), s));
    reference::Strands masses = straightStrand(3, 0.1);
    masses.pointMasses = {1.0, 1.0, 0.0, 1.0};
    EXPECT_FALSE(reference::Solver::make(masses, s));
    s.angularStiffness = 1.0f;
    EXPECT_FALSE(reference::Solver::make(straightStrand(3, 0.1), s));
}

}  // namespace
}  // namespace hairloom
