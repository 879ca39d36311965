// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/alternatives/projective_equations.h"
#include "tests/runtime/segment_methods.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

/// Period of a stick of 0.25 m that is let go 0.05 rad from its equilibrium towards `sideways`, in a gravity
/// that is turned from the stick's rest direction, −y, by `tilt` towards z.
double measuredPeriod(Float3 sideways, float tilt) {
    const Strands strands = oneSegment({0.0f, -1.0f, 0.0f}, 0.25f);
    const Float3 down{0.0f, -std::cos(tilt), std::sin(tilt)};
    SimulationSettings s = bare();
    s.substeps = 64;
    s.gravity = sideways * (9.81f * std::sin(0.05f)) + down * (9.81f * std::cos(0.05f));
    s.dampingTime = 0.05f;
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
    run(sticks, strands, 300);
    EXPECT_NEAR(dot(positionsOf(sticks)[1], sideways), 0.25f * std::sin(0.05f), 2e-5f);
    s.gravity = down * 9.81f;
    s.dampingTime = 0.0f;
    EXPECT_EQ(sticks.setSettings(s), "");
    std::vector<double> crossings;
    float before = dot(positionsOf(sticks)[1], sideways);
    for (int f = 0; f < 900; ++f) {
        run(sticks, strands, 1, 1.0f / 180.0f);
        const float now = dot(positionsOf(sticks)[1], sideways);
        if (before > 0.0f && now <= 0.0f)
            crossings.push_back((f + static_cast<double>(before / (before - now))) / 180.0);
        before = now;
    }
    if (crossings.size() < 3) return 0.0;
    return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

TEST(Projective, AStickIsThePhysicalPendulumInEitherAngle) {
    // T = 2π √(I / (m g l/2)) = 2π √(2 l / (3 g)), and 1 + φ₀²/16 for the amplitude.
    const double expected =
        2.0 * std::numbers::pi * std::sqrt(2.0 * 0.25 / (3.0 * 9.81)) * (1.0 + 0.05 * 0.05 / 16.0);
    EXPECT_NEAR(measuredPeriod({1.0f, 0.0f, 0.0f}, 0.0f), expected, 0.003 * expected);
    EXPECT_NEAR(measuredPeriod({0.0f, 0.0f, 1.0f}, 0.0f), expected, 0.003 * expected);
}

TEST(Projective, OffTheEquatorThetaIsSlowerByTheStatedCosine) {
    // Eq. 1 with a constant c and the projected lever: θ'' = −(3g/2l) cos²φ θ at the inclination φ.
    const double expected = 2.0 * std::numbers::pi * std::sqrt(2.0 * 0.25 / (3.0 * 9.81)) / std::cos(0.8);
    EXPECT_NEAR(measuredPeriod({1.0f, 0.0f, 0.0f}, 0.8f), expected, 0.005 * expected);
}

TEST(Projective, SideWindHoldsAStickAtItsClosedFormAngle) {
    // g sinψ = c w cos²ψ: gravity and the wind's pull c w sinα, sinα = cosψ, on the lever's two projections.
    for (const double wind : {1.0, 4.0, 20.0}) {
        const Strands strands = oneSegment({0.0f, -1.0f, 0.0f}, 0.1f);
        SimulationSettings s = bare();
        s.gravity = {0.0f, -9.81f, 0.0f};
        s.airDrag = 3.0f;
        s.windSpeed = static_cast<float>(wind);
        s.windGustiness = 0.0f;
        s.windDirection = {0.6f, 0.0f, 0.8f};
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
        run(sticks, strands, 1200);
        const double r = 3.0 * wind / 9.81;
        const double sine = (std::sqrt(1.0 + 4.0 * r * r) - 1.0) / (2.0 * r);
        const Float3 tip = positionsOf(sticks)[1];
        EXPECT_NEAR(static_cast<double>(tip.y), -0.1 * std::sqrt(1.0 - sine * sine), 2e-5) << wind;
        EXPECT_NEAR(static_cast<double>(tip.x), 0.06 * sine, 2e-5) << wind;
        EXPECT_NEAR(static_cast<double>(tip.z), 0.08 * sine, 2e-5) << wind;
    }
}

TEST(Projective, ASteadyPullBendsByItsClosedFormAngle) {
    // (3/2l) g cosθ = 3 B/(l̄ l³) θ with l̄ = l/2 at the root: l = 2 cm, B at stiffness 0.1, level stick.
    const double l = 0.02, stiffness = kHairBendingStiffness * 0.1 / 0.9;
    const double slope = 3.0 * stiffness / (0.5 * l * l * l * l);
    double angle = 0.0;
    for (int i = 0; i < 60; ++i) angle = 1.5 / l * 9.81 * std::cos(angle) / slope;
    const Strands strands = oneSegment({1.0f, 0.0f, 0.0f}, 0.02f);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.angularStiffness = 0.1f;
    s.restGravity = 0.0f;
    s.dampingTime = 0.2f;
    ProjectiveEquations sagging = makeMethod<ProjectiveEquations>(strands, s);
    run(sagging, strands, 300);
    EXPECT_NEAR(static_cast<double>(positionsOf(sagging)[1].y), -l * std::sin(angle), 1e-6);
    EXPECT_GT(angle, 0.05);
    s.restGravity = 1.0f;
    ProjectiveEquations hung = makeMethod<ProjectiveEquations>(strands, s);
    run(hung, strands, 300);
    EXPECT_NEAR(positionsOf(hung)[1].y, 0.0f, 1e-7f);
}

TEST(Projective, AnAcceleratingRootIsGravityAtAnAngle) {
    const Strands strands = oneSegment({0.0f, -1.0f, 0.0f}, 0.1f);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.dampingTime = 0.1f;
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
    for (int f = 1; f <= 180; ++f) {
        const float t = static_cast<float>(f) / 60.0f;
        sticks.step({1.0f / 60.0f, 0.0, strands.roots({2.0f * t * t, 0.0f, 0.0f}), {}});
    }
    const std::vector<Float3> now = positionsOf(sticks);
    EXPECT_NEAR((now[1] - now[0]).x / (now[1] - now[0]).y, 4.0f / 9.81f, 5e-3f);
}

TEST(Projective, LengthIsExactThroughViolentMotion) {
    const Strands strands = tuft(30, true);
    SimulationSettings s = springSettings();
    s.windSpeed = 30.0f;
    s.angularStiffness = 0.05f;
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
    const std::vector<Sphere> spheres{{{0.05f, 0.05f, 0.0f}, 0.06f}};
    for (int f = 1; f <= 200; ++f) {
        const auto roots = strands.roots({0.3f * std::sin(static_cast<float>(f)), 0.0f, 0.0f},
                                         turnAbout({0.0f, 1.0f, 0.0f}, static_cast<float>(f)));
        sticks.step({1.0f / 60.0f, f / 60.0, roots, spheres});
        ASSERT_LT(worstStretch(strands, positionsOf(sticks)), 2e-5) << f;
    }
}

TEST(Projective, AuthoredShapeComesBackAndTurnsWithTheRoot) {
    const Strands strands = tuft(5);
    SimulationSettings s = springSettings();
    s.gravity = {};
    s.airDrag = 0.0f;
    s.dampingTime = 0.1f;
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
    const Quat turn = turnAbout({0.6f, 0.0f, 0.8f}, 1.2f);
    for (int f = 1; f <= 10; ++f) {
        const auto roots = strands.roots({}, turnAbout({0.6f, 0.0f, 0.8f}, 0.12f * static_cast<float>(f)));
        sticks.step({1.0f / 60.0f, 0.0, roots, {}});
    }
    const auto worst = [&] {
        float maximum = 0.0f;
        const std::vector<Float3> now = positionsOf(sticks);
        for (std::size_t i = 0; i < now.size(); ++i)
            maximum = std::max(maximum, length(now[i] - rotate(turn, strands.points[i])));
        return maximum;
    };
    EXPECT_GT(worst(), 1e-3f) << "inertia leaves the hair behind";
    for (int f = 0; f < 300; ++f) sticks.step({1.0f / 60.0f, 0.0, strands.roots({}, turn), {}});
    EXPECT_LT(worst(), 1e-5f);
}

TEST(Projective, WithoutTorqueAStickKeepsItsDirectionWhileItsRootTurns) {
    for (const Float3 axis : {Float3{0, 0, 1}, Float3{0, 1, 0}, Float3{1, 0, 0}, Float3{0, 0.6f, -0.8f}}) {
        const Strands strands = oneSegment({1.0f, 0.0f, 0.0f}, 0.1f);
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, bare());
        for (int f = 1; f <= 10; ++f) {
            const auto roots = strands.roots({}, turnAbout(axis, 0.02f * static_cast<float>(f)));
            sticks.step({1.0f / 60.0f, 0.0, roots, {}});
        }
        EXPECT_LT(length(positionsOf(sticks)[1] - Float3{0.1f, 0.0f, 0.0f}), 3e-4f) << axis.x << axis.y;
    }
}

TEST(Projective, RigidHairMovesAsItsRootDoes) {
    const Strands strands = tuft(3);
    SimulationSettings s = springSettings();
    s.angularStiffness = 1.0f;
    s.angularCurve = {};
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
    for (int f = 1; f <= 5; ++f) {
        const float angle = 0.002f * static_cast<float>(f);
        sticks.step(
            {1.0f / 60.0f,
             0.0,
             strands.roots({0.05f * static_cast<float>(f), 0.0f, 0.0f}, turnAbout({0.0f, 1.0f, 0.0f}, angle)),
             {}});
    }
    const Quat turn = turnAbout({0.0f, 1.0f, 0.0f}, 0.01f);
    std::vector<Float3> velocities(sticks.pointCount());
    sticks.readVelocities(velocities);
    const std::vector<Float3> now = positionsOf(sticks);
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Float3 arm = rotate(turn, strands.points[i]);
        EXPECT_LT(length(now[i] - arm - Float3{0.25f, 0.0f, 0.0f}), 1e-6f) << i;
        const Float3 expected = Float3{3.0f, 0.0f, 0.0f} + cross({0.0f, 0.12f, 0.0f}, arm);
        EXPECT_LT(length(velocities[i] - expected), 2e-3f) << i;
    }
}

TEST(Projective, NoStepSizeLiftsAStickAboveWhereItStarted) {
    for (const float dt : {1e-3f, 1.0f / 60.0f, 0.2f, 1.0f, 30.0f}) {
        const Strands strands = oneSegment({0.8f, 0.6f, 0.0f}, 0.03f);
        SimulationSettings s = bare();
        s.substeps = 1;
        s.gravity = {4.0f, -9.81f, 7.0f};
        ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
        const auto potential = [&] { return -static_cast<double>(dot(s.gravity, positionsOf(sticks)[1])); };
        const double start = potential();
        for (int f = 0; f < 400; ++f) {
            run(sticks, strands, 1, dt);
            ASSERT_LE(potential(), start + 1e-5) << dt;
        }
        // Long steps come to rest where the stick hangs.
        const double lowest = -static_cast<double>(0.03f * length(s.gravity));
        EXPECT_NEAR(potential(), lowest, dt >= 0.2f ? 1e-5 : 1.0) << dt;
    }
}

TEST(Projective, PushBeyondThePoleTakesTheShorterArc) {
    Stick stick = makeStick({0.1f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
    StickMotion motion;
    motion.theta = 0.2f;
    motion.phi = 2.0f;
    const Float3 tip = polarOf(stick, motion).direction * 0.1f;
    const Float3 centre = tip + Float3{0.01f, 0.002f, 0.003f};
    pushOut(stick, motion, centre, 0.03f);
    EXPECT_NEAR(length(polarOf(stick, motion).direction * 0.1f - centre), 0.03f, 1e-6f);
    EXPECT_NEAR(motion.phi, 2.0f, 0.5f);
    EXPECT_NEAR(motion.theta, 0.2f, 0.8f);
}

TEST(Projective, AtThePoleAStickStaysSoundAndComesBack) {
    // The pole of hair along x stands on z: wind blows the stick over it and beyond.
    const Strands strands = oneSegment({1.0f, 0.0f, 0.0f}, 0.03f);
    SimulationSettings s = bare();
    s.gravity = {0.0f, 0.0f, 50.0f};
    s.dampingTime = 0.3f;
    ProjectiveEquations sticks = makeMethod<ProjectiveEquations>(strands, s);
    run(sticks, strands, 600);
    EXPECT_LT(length(positionsOf(sticks)[1] - Float3{0.0f, 0.0f, 0.03f}), 1e-5f);
    s.gravity = {50.0f, 0.0f, 0.0f};
    ASSERT_EQ(sticks.setSettings(s), "");
    run(sticks, strands, 600);
    EXPECT_LT(length(positionsOf(sticks)[1] - Float3{0.03f, 0.0f, 0.0f}), 1e-5f);
}

}  // namespace
}  // namespace hairloom::runtime
