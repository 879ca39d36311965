// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/alternatives/rigid_chains.h"

#include "tests/runtime/segment_methods.h"
#include "tests/simulation/elastica.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr double kEarthGravity = 9.81;
const Float3 kDown{0.0f, -9.81f, 0.0f};

float farthestFrom(const std::vector<Float3>& now, const std::vector<Float3>& expected) {
    float worst = 0.0f;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const float away = length(now[i] - expected[i]);
        if (!(away <= worst)) worst = away;
    }
    return worst;
}

TEST(RigidChains, OneSegmentIsThePhysicalPendulumAtAnyAmplitude) {
    // T = 2π √(2 l/(3 g)) / agm(1, cos(θ₀/2)), exactly.
    for (const double start : {0.05, 1.5, 2.8}) {
        double a = 1.0, b = std::cos(0.5 * start);
        for (int i = 0; i < 8; ++i) {
            const double mean = 0.5 * (a + b);
            b = std::sqrt(a * b);
            a = mean;
        }
        const double expected = 2.0 * std::numbers::pi * std::sqrt(2.0 * 0.25 / (3.0 * kEarthGravity)) / a;
        const float angle = static_cast<float>(start);
        const Strands strands = oneSegment({std::sin(angle), -std::cos(angle), 0.0f}, 0.25f);
        SimulationSettings s = bare();
        s.gravity = kDown;
        s.substeps = 256;
        RigidChains chains = makeMethod<RigidChains>(strands, s);
        // From rest to the lowest point is a quarter of the first period.
        const float dt = 1.0f / 960.0f;
        float before = angle;
        double quarter = 0.0;
        for (int f = 1; f < 2000 && quarter == 0.0; ++f) {
            run(chains, strands, 1, dt);
            const Float3 tip = positionsOf(chains)[1];
            const float now = std::atan2(tip.x, -tip.y);
            if (before > 0.0f && now <= 0.0f)
                quarter = (f - 1 + static_cast<double>(before / (before - now))) * static_cast<double>(dt);
            before = now;
        }
        EXPECT_NEAR(4.0 * quarter, expected, 0.002 * expected) << start;
    }
}

/// Two thin rods, angles from the vertical: Lagrange's equations by RK4.
struct DoublePendulum {
    double first, second;                   ///< lengths, metres; masses alike
    double a, b, aRate = 0.0, bRate = 0.0;  ///< radians, 1/s

    struct Rates {
        double a, b, aRate, bRate;
    };
    Rates rates(double at, double bt, double ar, double br) const {
        const double m1 = first, m2 = second, l1 = first, l2 = second, g = kEarthGravity;
        const double j1 = m1 * l1 * l1 / 3 + m2 * l1 * l1, j2 = m2 * l2 * l2 / 3;
        const double c = 0.5 * m2 * l1 * l2 * std::cos(at - bt), s = 0.5 * m2 * l1 * l2 * std::sin(at - bt);
        const double f1 = -s * br * br - g * std::sin(at) * (0.5 * m1 + m2) * l1;
        const double f2 = s * ar * ar - 0.5 * g * std::sin(bt) * m2 * l2;
        const double determinant = j1 * j2 - c * c;
        return {ar, br, (j2 * f1 - c * f2) / determinant, (j1 * f2 - c * f1) / determinant};
    }
    void step(double h) {
        const auto from = [&](const Rates& r, double share) {
            return rates(a + share * r.a, b + share * r.b, aRate + share * r.aRate, bRate + share * r.bRate);
        };
        const Rates k1 = rates(a, b, aRate, bRate), k2 = from(k1, 0.5 * h), k3 = from(k2, 0.5 * h),
                    k4 = from(k3, h);
        a += h / 6 * (k1.a + 2 * k2.a + 2 * k3.a + k4.a);
        b += h / 6 * (k1.b + 2 * k2.b + 2 * k3.b + k4.b);
        aRate += h / 6 * (k1.aRate + 2 * k2.aRate + 2 * k3.aRate + k4.aRate);
        bRate += h / 6 * (k1.bRate + 2 * k2.bRate + 2 * k3.bRate + k4.bRate);
    }
};

/// Largest distance of two segments' points from the double pendulum's within a second, as shares of 0.3 m.
double doublePendulumError(std::uint32_t substeps) {
    Strands strands;
    const Float3 one{std::sin(1.2f), -std::cos(1.2f), 0.0f}, two{std::sin(-0.4f), -std::cos(-0.4f), 0.0f};
    strands.add({}, one, 0.1f, 3);
    strands.points[1] = one * 0.1f;
    strands.points[2] = one * 0.1f + two * 0.2f;
    SimulationSettings s = bare();
    s.gravity = kDown;
    s.substeps = substeps;
    RigidChains chains = makeMethod<RigidChains>(strands, s);
    DoublePendulum exact{0.1, 0.2, static_cast<double>(1.2f), static_cast<double>(-0.4f)};
    double worst = 0.0;
    for (int f = 0; f < 240; ++f) {
        run(chains, strands, 1, 1.0f / 240.0f);
        for (int i = 0; i < 20; ++i) exact.step(1.0 / 4800.0);
        const Float3 tip = positionsOf(chains)[2];
        worst = std::max(
            worst,
            std::hypot(static_cast<double>(tip.x) - 0.1 * std::sin(exact.a) - 0.2 * std::sin(exact.b),
                       static_cast<double>(tip.y) + 0.1 * std::cos(exact.a) + 0.2 * std::cos(exact.b)));
    }
    return worst / 0.3;
}

TEST(RigidChains, TwoSegmentsAreTheDoublePendulumToFirstOrder) {
    const double coarse = doublePendulumError(64), fine = doublePendulumError(256);
    EXPECT_LT(fine, 0.02);
    EXPECT_NEAR(coarse / fine, 4.0, 1.0);
}

TEST(RigidChains, ASaggingChainIsTheHeavyElastica) {
    // 19 segments bend; the first is held. Drops by a third of its length.
    const double l = 0.004, free = 19 * l;
    const double B = test::elasticaStiffness(0.33, kEarthGravity, free);
    const test::ElasticaShape exact = test::solveElastica(B, kEarthGravity, free);
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, static_cast<float>(l), 21);
    SimulationSettings s = bare();
    s.gravity = kDown;
    s.clampedPoints = 2;
    s.angularStiffness = static_cast<float>(B / (B + kHairBendingStiffness));
    s.angularCurve = {};
    s.restGravity = 0.0f;
    s.dampingTime = 0.1f;
    RigidChains chains = makeMethod<RigidChains>(strands, s);
    run(chains, strands, 600);
    const Float3 tip = positionsOf(chains).back();
    EXPECT_NEAR(static_cast<double>(-tip.y), exact.drop, 0.01 * free);
    EXPECT_NEAR(static_cast<double>(tip.x) - l, exact.reach, 0.01 * free);
    // And with its springs turned against its weight it stays as authored.
    s.restGravity = 1.0f;
    RigidChains held = makeMethod<RigidChains>(strands, s);
    run(held, strands, 300);
    EXPECT_LT(farthestFrom(positionsOf(held), strands.points), 1e-5f);
}

TEST(RigidChains, AuthoredShapesHangAsTheyAre) {
    const Strands strands = tuft(20, true);
    SimulationSettings s = springSettings();
    s.angularStiffness = 0.3f;
    s.angularCurve = {};
    RigidChains chains = makeMethod<RigidChains>(strands, s);
    run(chains, strands, 120);
    EXPECT_LT(farthestFrom(positionsOf(chains), strands.points), 5e-4f);
}

TEST(RigidChains, AnAcceleratingRootIsGravityAtAnAngle) {
    const Strands strands = oneSegment({0.0f, -1.0f, 0.0f}, 0.1f);
    SimulationSettings s = bare();
    s.gravity = kDown;
    s.dampingTime = 0.1f;
    RigidChains chains = makeMethod<RigidChains>(strands, s);
    for (int f = 1; f <= 180; ++f) {
        const float t = static_cast<float>(f) / 60.0f;
        chains.step({1.0f / 60.0f, 0.0, strands.roots({2.0f * t * t, 0.0f, 0.0f}), {}});
    }
    const std::vector<Float3> now = positionsOf(chains);
    EXPECT_NEAR((now[1] - now[0]).x / (now[1] - now[0]).y, 4.0f / 9.81f, 5e-3f);
}

TEST(RigidChains, SideWindHoldsASegmentAtItsClosedFormAngle) {
    // g sinψ = c w cos²ψ, as for the sticks of projective equations.
    for (const double wind : {1.0, 4.0, 20.0}) {
        const Strands strands = oneSegment({0.0f, -1.0f, 0.0f}, 0.1f);
        SimulationSettings s = bare();
        s.gravity = kDown;
        s.airDrag = 3.0f;
        s.windSpeed = static_cast<float>(wind);
        s.windGustiness = 0.0f;
        s.windDirection = {0.6f, 0.0f, 0.8f};
        RigidChains chains = makeMethod<RigidChains>(strands, s);
        run(chains, strands, 1200);
        const double r = 3.0 * wind / kEarthGravity, sine = (std::sqrt(1.0 + 4.0 * r * r) - 1.0) / (2.0 * r);
        const Float3 tip = positionsOf(chains)[1];
        EXPECT_NEAR(static_cast<double>(tip.y), -0.1 * std::sqrt(1.0 - sine * sine), 2e-5) << wind;
        EXPECT_NEAR(static_cast<double>(tip.x), 0.06 * sine, 2e-5) << wind;
        EXPECT_NEAR(static_cast<double>(tip.z), 0.08 * sine, 2e-5) << wind;
    }
}

TEST(RigidChains, WithoutTorqueAFreeSegmentKeepsItsDirectionWhileItsRootTurns) {
    for (const Float3 axis : {Float3{0, 0, 1}, Float3{0, 1, 0}, Float3{1, 0, 0}, Float3{0, 0.6f, -0.8f}}) {
        const Strands strands = oneSegment({1.0f, 0.0f, 0.0f}, 0.1f);
        RigidChains chains = makeMethod<RigidChains>(strands, bare());
        for (int f = 1; f <= 60; ++f) {
            const auto roots = strands.roots({}, turnAbout(axis, 0.1f * static_cast<float>(f)));
            chains.step({1.0f / 60.0f, 0.0, roots, {}});
        }
        EXPECT_LT(length(positionsOf(chains)[1] - Float3{0.1f, 0.0f, 0.0f}), 1e-6f) << axis.x << axis.y;
    }
}

/// Kinetic and potential energy out of points alone: segments are thin rods.
double energyOf(const RigidChains& chains, const Strands& strands, Float3 gravity) {
    const std::vector<Float3> at = positionsOf(chains);
    std::vector<Float3> speeds(at.size());
    chains.readVelocities(speeds);
    double energy = 0.0;
    for (std::uint32_t s = 0; s < strands.count(); ++s) {
        for (std::uint32_t p = strands.offsets[s] + 1; p < strands.offsets[s + 1]; ++p) {
            const double mass = static_cast<double>(length(strands.points[p] - strands.points[p - 1]));
            const Float3 u = speeds[p - 1], v = speeds[p];
            energy += mass * static_cast<double>(dot(u, u) + dot(u, v) + dot(v, v)) / 6.0;
            energy -= 0.5 * mass * static_cast<double>(dot(gravity, at[p - 1] + at[p]));
        }
    }
    return energy;
}

TEST(RigidChains, FallingChainsGainNoEnergyAndLoseLessInFinerSteps) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.02f, 13);
    double lost[2];
    for (int fine = 0; fine < 2; ++fine) {
        SimulationSettings s = bare();
        s.gravity = kDown;
        s.substeps = fine == 1 ? 256 : 16;
        RigidChains chains = makeMethod<RigidChains>(strands, s);
        const double start = energyOf(chains, strands, s.gravity);
        for (int f = 0; f < 60; ++f) {
            run(chains, strands, 1);
            ASSERT_LT(energyOf(chains, strands, s.gravity), start + 1e-5) << f;
        }
        lost[fine] = start - energyOf(chains, strands, s.gravity);
    }
    // It can lose 0.24² · 9.81 / 2 = 0.28.
    EXPECT_LT(lost[1], 0.05);
    EXPECT_LT(lost[1], 0.6 * lost[0]);
}

TEST(RigidChains, LengthIsExactAndNothingBlowsUpInStorms) {
    Strands strands = tuft(10, true);
    for (int i = 0; i < 3; ++i)
        strands.add({0.01f * static_cast<float>(i), 0.1f, 0.0f}, hangingAt(0.9f * static_cast<float>(i)),
                    0.008f, 64);
    for (const float stiffness : {0.0f, 0.01f, 0.3f, 1.0f}) {
        for (const std::uint32_t substeps : {1u, 2u, 8u}) {
            SimulationSettings s = springSettings();
            s.windSpeed = 30.0f;
            s.angularStiffness = stiffness;
            s.substeps = substeps;
            RigidChains chains = makeMethod<RigidChains>(strands, s);
            const std::vector<Sphere> spheres{{{0.05f, 0.05f, 0.0f}, 0.06f}};
            for (int f = 1; f <= 120; ++f) {
                const auto roots = strands.roots({0.3f * std::sin(static_cast<float>(f)), 0.0f, 0.0f},
                                                 turnAbout({0.0f, 1.0f, 0.0f}, static_cast<float>(f)));
                chains.step({1.0f / 60.0f, f / 60.0, roots, spheres});
                ASSERT_LT(worstStretch(strands, positionsOf(chains)), 2e-5) << stiffness << " " << f;
            }
            s.windSpeed = 0.0f;
            s.gravity = kDown;
            ASSERT_EQ(chains.setSettings(s), "");
            run(chains, strands, 900);
            std::vector<Float3> speeds(chains.pointCount());
            chains.readVelocities(speeds);
            for (const Float3& v : speeds) ASSERT_LT(length(v), 0.5f) << stiffness << " " << substeps;
        }
    }
}

TEST(RigidChains, RigidHairMovesAsItsRootDoes) {
    const Strands strands = tuft(3);
    SimulationSettings s = springSettings();
    s.angularStiffness = 1.0f;
    s.angularCurve = {};
    RigidChains chains = makeMethod<RigidChains>(strands, s);
    for (int f = 1; f <= 30; ++f) {
        const float n = static_cast<float>(f);
        chains.step({1.0f / 60.0f,
                     0.0,
                     strands.roots({0.05f * n, 0.0f, 0.0f}, turnAbout({0.0f, 1.0f, 0.0f}, 0.002f * n)),
                     {}});
    }
    const Quat turn = turnAbout({0.0f, 1.0f, 0.0f}, 0.06f);
    std::vector<Float3> velocities(chains.pointCount());
    chains.readVelocities(velocities);
    const std::vector<Float3> now = positionsOf(chains);
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Float3 arm = rotate(turn, strands.points[i]);
        EXPECT_LT(length(now[i] - arm - Float3{1.5f, 0.0f, 0.0f}), 1e-5f) << i;
        EXPECT_LT(length(velocities[i] - Float3{3.0f, 0.0f, 0.0f}), 0.1f) << i;
    }
}

}  // namespace
}  // namespace hairloom::runtime
