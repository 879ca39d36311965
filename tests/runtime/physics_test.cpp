// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

TEST(Physics, FreePointsFallAsTheClosedFormSays) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.05f, 5);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.lengthIterations = 0;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 30);
    const double t = 0.5;
    for (std::size_t p = 1; p < 5; ++p) {
        EXPECT_NEAR(static_cast<double>(positionsOf(engine)[p].y), -9.81 * t * t / 2, 2e-4);
    }
}

TEST(Physics, AHangingStrandStaysAtItsRestLength) {
    Strands strands;
    strands.add({0.3f, 1.7f, 0.2f}, {0.0f, -1.0f, 0.0f}, 0.02f, 16);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 300);
    EXPECT_LT(engine.measure().maxStretch, 1e-4);
    EXPECT_NEAR(positionsOf(engine)[15].y, 1.7f - 0.3f, 5e-5f);
    EXPECT_NEAR(positionsOf(engine)[15].x, 0.3f, 1e-6f);
}

TEST(Physics, APendulumSwingsWithTheClosedFormsPeriod) {
    const float l = 0.25f;
    Strands strands;
    strands.add({}, hangingAt(0.05f), l, 2);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.substeps = 16;
    Engine engine = makeEngine(strands, s);
    const std::vector<RootFrame> roots = strands.roots();
    std::vector<double> crossings;
    float before = positionsOf(engine)[1].x;
    for (int f = 0; f < 900; ++f) {
        engine.step({1.0f / 180.0f, 0.0, roots, {}});
        const float now = positionsOf(engine)[1].x;
        if (before > 0.0f && now <= 0.0f)
            crossings.push_back((f + static_cast<double>(before / (before - now))) / 180.0);
        before = now;
    }
    ASSERT_GE(crossings.size(), 4u);
    const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    const double expected = 2.0 * std::numbers::pi * std::sqrt(0.25 / 9.81) * (1.0 + 0.05 * 0.05 / 16.0);
    EXPECT_NEAR(period, expected, 0.005 * expected);
}

TEST(Physics, DampingTimeDoesNotDependOnSubsteps) {
    for (const std::uint32_t substeps : {1u, 4u, 16u}) {
        Strands strands;
        strands.add({}, {1.0f, 0.0f, 0.0f}, 0.05f, 3);
        SimulationSettings s = bare();
        s.lengthIterations = 0;
        s.dampingTime = 0.3f;
        s.substeps = substeps;
        Engine engine = makeEngine(strands, s);
        // One frame of gravity gives speed, then it decays.
        s.gravity = {0.0f, -60.0f, 0.0f};
        ASSERT_EQ(engine.setSettings(s), "");
        run(engine, strands, 1);
        s.gravity = {};
        ASSERT_EQ(engine.setSettings(s), "");
        std::vector<Float3> v(3);
        engine.readVelocities(v);
        const float start = v[2].y;
        run(engine, strands, 30);
        engine.readVelocities(v);
        EXPECT_NEAR(v[2].y / start, std::exp(-0.5f / 0.3f), 2e-3f) << substeps;
    }
}

TEST(Physics, AirDragReachesItsTerminalSpeedForAnyFrameTime) {
    for (const float dt : {1.0f / 240.0f, 1.0f / 30.0f}) {
        Strands strands;
        strands.add({}, {1.0f, 0.0f, 0.0f}, 0.05f, 2);
        SimulationSettings s = bare();
        s.lengthIterations = 0;
        s.airDrag = 20.0f;
        s.windSpeed = 5.0f;
        s.windGustiness = 0.0f;
        s.windDirection = {0.0f, 0.0f, 0.5f};
        Engine engine = makeEngine(strands, s);
        const std::vector<RootFrame> roots = strands.roots();
        engine.step({dt, 0.0, roots, {}});
        std::vector<Float3> v(2);
        engine.readVelocities(v);
        // From rest, broadside: v = u(1 − exp(−airDrag·t)), while the point has hardly left its position; the
        // velocity is that of half a substep ago.
        const float ago = 0.5f * dt / static_cast<float>(substepsIn(s, dt));
        EXPECT_NEAR(v[1].z, 5.0f * (1.0f - std::exp(-20.0f * (dt - ago))), 0.12f) << dt;
    }
}

TEST(Physics, WindAlongAStrandLeavesItAlone) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.02f, 8);
    SimulationSettings s = bare();
    s.airDrag = 10.0f;
    s.windSpeed = 20.0f;
    s.windGustiness = 0.0f;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 60);
    EXPECT_NEAR(positionsOf(engine)[7].x, 0.14f, 1e-5f);
    EXPECT_EQ(positionsOf(engine)[7].y, 0.0f);
}

TEST(Physics, AngularSpringsRestoreTheRestShape) {
    const Strands strands = tuft(5);
    SimulationSettings s = bare();
    s.angularStiffness = 0.4f;
    s.dampingTime = 0.1f;
    s.gravity = {30.0f, -10.0f, 5.0f};
    s.clampedPoints = 2;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 60);
    const auto errorOf = [&] {
        float worst = 0.0f;
        const std::vector<Float3> now = positionsOf(engine);
        for (std::size_t i = 0; i < now.size(); ++i)
            worst = std::max(worst, length(now[i] - strands.points[i]));
        return worst;
    };
    EXPECT_GT(errorOf(), 0.02f) << "the pull should have bent it";
    s.gravity = {};
    ASSERT_EQ(engine.setSettings(s), "");
    run(engine, strands, 300);
    EXPECT_LT(errorOf(), 1e-4f);
}

/// One segment of length l on an elastic clamp: the tip of mass m on κ/l², κ = B·μ/(l/2).
double clampFrequency(double stiffness, double l) {
    const double bending = kHairBendingStiffness * stiffness / (1.0 - stiffness);
    // Two points of equal masses: m = 1, and 2/l of mass per length.
    const double kappa = bending * (2.0 / l) / (0.5 * l);
    return std::sqrt(kappa) / l;
}

TEST(Physics, AnAngularSpringSwingsAtItsFrequencyForAnySubstepCount) {
    const double omega = clampFrequency(0.5, 0.05);
    const double period = 2.0 * std::numbers::pi / omega;
    for (const std::uint32_t substeps : {4u, 8u, 16u}) {
        Strands strands;
        strands.add({}, {0.0f, -1.0f, 0.0f}, 0.05f, 2);
        SimulationSettings s = bare();
        s.angularStiffness = 0.5f;
        s.bendDampingTime = 0.0f;
        s.substeps = substeps;
        s.gravity = {0.5f, 0.0f, 0.0f};
        Engine engine = makeEngine(strands, s);
        const float dt = static_cast<float>(period / 40.0);
        std::vector<double> crossings;
        float before = positionsOf(engine)[1].x;
        const double sag = 0.5 / (omega * omega);
        double maximum = 0.0;
        for (int f = 0; f < 400; ++f) {
            run(engine, strands, 1, dt);
            const float now = positionsOf(engine)[1].x;
            maximum = std::max(maximum, static_cast<double>(now));
            const auto middle = static_cast<float>(sag);
            if (before < middle && now >= middle)
                crossings.push_back((f + static_cast<double>((middle - before) / (now - before))) *
                                    static_cast<double>(dt));
            before = now;
        }
        ASSERT_GE(crossings.size(), 8u) << substeps;
        const double measured =
            (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
        EXPECT_NEAR(measured, period, 0.01 * period) << substeps;
        EXPECT_NEAR(maximum, 2.0 * sag, 0.05 * sag) << "twice the sag at rest, without damping";
    }
}

TEST(Physics, AngularSpringsSagByTheClosedFormUnderASteadyPull) {
    for (const Integrator integrator : {Integrator::verlet, Integrator::velocityVerlet, Integrator::leapfrog,
                                        Integrator::implicitEuler, Integrator::rk4}) {
        Strands strands;
        strands.add({}, {0.0f, -1.0f, 0.0f}, 0.05f, 2);
        SimulationSettings s = bare();
        s.integrator = integrator;
        s.angularStiffness = 0.5f;
        s.restGravity = 0.0f;
        s.dampingTime = 0.1f;
        s.gravity = {0.5f, 0.0f, 0.0f};
        Engine engine = makeEngine(strands, s);
        run(engine, strands, 300);
        const double omega = clampFrequency(0.5, 0.05);
        EXPECT_NEAR(static_cast<double>(positionsOf(engine)[1].x), 0.5 / (omega * omega), 1e-5)
            << static_cast<int>(integrator);
    }
}

TEST(Physics, AStiffStrandFollowsItsRoot) {
    const Strands strands = tuft(3);
    SimulationSettings s = springSettings();
    s.angularStiffness = 1.0f;
    s.angularCurve = {};
    s.gravity = {};
    s.airDrag = 0.0f;
    Engine engine = makeEngine(strands, s);
    const Float3 axis{0.6f, 0.0f, 0.8f};
    std::vector<RootFrame> roots;
    for (int f = 1; f <= 10; ++f) {
        roots = strands.roots({0.0f, 0.01f * static_cast<float>(f), 0.0f},
                              turnAbout(axis, 0.05f * static_cast<float>(f)));
        engine.step({1.0f / 60.0f, 0.0, roots, {}});
    }
    for (int f = 0; f < 60; ++f) engine.step({1.0f / 60.0f, 0.0, roots, {}});
    const std::vector<Float3> now = positionsOf(engine);
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Float3 expected = rotate(turnAbout(axis, 0.5f), strands.points[i]) + Float3{0.0f, 0.1f, 0.0f};
        EXPECT_LT(length(now[i] - expected), 1e-4f) << i;
    }
}

TEST(Physics, UniformMotionIsGalileanInvariant) {
    const Strands strands = tuft(4);
    SimulationSettings s = bare();
    s.dampingTime = 0.2f;
    s.angularStiffness = 0.2f;
    Engine engine = makeEngine(strands, s);
    const auto ride = [&](int f) {
        const auto roots = strands.roots({0.02f * static_cast<float>(f), 0.0f, 0.0f});
        engine.step({1.0f / 60.0f, 0.0, roots, {}});
    };
    for (int f = 1; f <= 240; ++f) ride(f);
    const std::vector<Float3> now = positionsOf(engine);
    for (std::size_t i = 0; i < now.size(); ++i) {
        EXPECT_LT(length(now[i] - Float3{4.8f, 0.0f, 0.0f} - strands.points[i]), 1e-3f) << i;
    }
}

}  // namespace
}  // namespace hairloom::runtime
