// SPDX-License-Identifier: GPL-3.0-or-later
// The alternatives that the settings offer: integrators, coil springs, flexion springs; sleep; recovery.
#include <gmock/gmock.h>

#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr Integrator kIntegrators[] = {Integrator::verlet,        Integrator::velocityVerlet,
                                       Integrator::leapfrog,      Integrator::explicitEuler,
                                       Integrator::implicitEuler, Integrator::rk4};

/// A hanging chain of coil springs stretches by the weight below each: g · (mass below) / k.
TEST(CoilSprings, StretchByTheWeightBelowThem) {
    constexpr std::uint32_t kCount = 5;
    for (const Integrator integrator : kIntegrators) {
        if (integrator == Integrator::explicitEuler) continue;  // gains energy on any undamped spring
        Strands strands;
        strands.add({}, {0.0f, -1.0f, 0.0f}, 0.05f, kCount);
        SimulationSettings s = bare();
        s.integrator = integrator;
        s.lengthMethod = LengthMethod::springs;
        s.lengthIterations = 0;
        s.springFrequency = 10.0f;
        s.dampingTime = 0.1f;
        s.gravity = {0.0f, -9.81f, 0.0f};
        s.substeps = 16;
        Engine engine = makeEngine(strands, s);
        run(engine, strands, 300);
        const std::vector<Float3> now = positionsOf(engine);
        // Masses: ends half as heavy as the others, with the mean 1.
        const double inner = 5.0 / 4.0, end = inner / 2.0;
        const double omega = 2.0 * std::numbers::pi * 10.0;
        double below = end;
        for (std::uint32_t p = kCount - 1; p > 0; --p) {
            const bool last = p == kCount - 1 || p == 1;
            const double mean = last ? 2.0 / (1.0 / inner + 1.0 / end) : inner;
            const double stretch = 9.81 * below / (mean * omega * omega);
            const double size = static_cast<double>(now[p - 1].y - now[p].y);
            EXPECT_NEAR(size, 0.05 + stretch, 0.01 * stretch + 1e-6)
                << static_cast<int>(integrator) << ' ' << p;
            below += inner;
        }
    }
}

TEST(CoilSprings, NeverPassTheirMaximalExtension) {
    for (const LengthMethod method : {LengthMethod::springs, LengthMethod::springVelocities}) {
        const Strands strands = tuft(6);
        SimulationSettings s = bare();
        s.lengthMethod = method;
        s.springFrequency = 20.0f;
        s.maximalExtension = 0.1f;
        s.lengthIterations = 8;
        s.gravity = {0.0f, -60.0f, 0.0f};
        Engine engine = makeEngine(strands, s);
        double maximum = 0.0;
        for (int f = 0; f < 240; ++f) {
            run(engine, strands, 1);
            maximum = std::max(maximum, engine.measure().maxStretch);
        }
        EXPECT_GT(maximum, 0.05) << "it should have been pulled";
        // Root to tip by positions the bound is exact; passes of impulses approach it.
        EXPECT_LT(maximum, method == LengthMethod::springs ? 0.1001 : 0.25);
    }
}

/// A strand with a right angle in its middle, pressed through to the mirrored side and let go.
Float3 tipAfterBeingPressedThrough(AngularMethod method) {
    Strands strands;
    strands.points = {{0, 0, 0}, {0, -0.02f, 0}, {0, -0.04f, 0}, {0.02f, -0.04f, 0}, {0.04f, -0.04f, 0}};
    strands.offsets = {0, 5};
    SimulationSettings s = bare();
    s.clampedPoints = 2;
    s.angularMethod = method;
    s.angularStiffness = 0.2f;
    s.angularCurve = {};
    s.restGravity = 0.0f;
    s.dampingTime = 0.05f;
    s.substeps = 64;
    Engine engine = makeEngine(strands, s);
    s.gravity = {-200.0f, 0.0f, 0.0f};
    EXPECT_EQ(engine.setSettings(s), "");
    run(engine, strands, 120);
    EXPECT_LT(positionsOf(engine)[4].x, -0.01f) << "the pull should have turned it over";
    s.gravity = {};
    EXPECT_EQ(engine.setSettings(s), "");
    run(engine, strands, 600);
    return positionsOf(engine)[4];
}

TEST(FlexionSprings, HaveSeveralRestShapesWhereAngularOnesHaveOne) {
    EXPECT_GT(tipAfterBeingPressedThrough(AngularMethod::smallAngle).x, 0.039f);
    EXPECT_GT(tipAfterBeingPressedThrough(AngularMethod::exact).x, 0.039f);
    EXPECT_GT(tipAfterBeingPressedThrough(AngularMethod::implicit).x, 0.039f);
    // Every second pair of points has its rest distance on the mirrored side as well.
    EXPECT_LT(tipAfterBeingPressedThrough(AngularMethod::flexion).x, -0.01f);
}

TEST(Integrators, AllComeToRestInTheSameShape) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.02f, 6);
    SimulationSettings s = bare();
    s.clampedPoints = 2;
    s.angularStiffness = 0.5f;
    s.angularCurve = {};
    s.restGravity = 0.0f;
    s.dampingTime = 0.1f;
    s.substeps = 32;
    s.gravity = {0.0f, -9.81f, 0.0f};
    std::vector<Float3> first;
    for (const Integrator integrator : kIntegrators) {
        s.integrator = integrator;
        Engine engine = makeEngine(strands, s);
        run(engine, strands, 600);
        const std::vector<Float3> now = positionsOf(engine);
        if (integrator == Integrator::explicitEuler) {
            EXPECT_GT(length(now[5] - first[5]), 1e-3f) << "grows without bound; see docs/stability.md";
            continue;
        }
        if (first.empty()) first = now;
        EXPECT_LT(now[5].y, -0.01f) << "it should sag";
        for (std::size_t p = 0; p < now.size(); ++p)
            EXPECT_LT(length(now[p] - first[p]), 2e-4f) << static_cast<int>(integrator) << ' ' << p;
    }
}

TEST(Integrators, CanBeChangedInMidRun) {
    const Strands strands = tuft(10);
    SimulationSettings s = springSettings();
    Engine engine = makeEngine(strands, s);
    for (int round = 0; round < 4; ++round) {
        for (const Integrator integrator : kIntegrators) {
            s.integrator = integrator;
            // Explicit forces of this stiffness need steps of half a millisecond.
            s.substeps = integrator == Integrator::verlet || integrator == Integrator::implicitEuler ? 8 : 40;
            ASSERT_EQ(engine.setSettings(s), "");
            run(engine, strands, 10);
            EXPECT_EQ(engine.lastStep().restoredStrands, 0u) << static_cast<int>(integrator);
            EXPECT_LT(engine.measure().maxStretch, 0.01) << static_cast<int>(integrator);
        }
    }
}

/// Hair that hangs still, asleep.
struct Sleeping {
    Strands strands = tuft(40);
    SimulationSettings settings;
    Engine engine;

    explicit Sleeping(const SimulationSettings& s) : settings(s), engine(makeEngine(strands, settings)) {
        run(engine, strands, 900);
        EXPECT_EQ(engine.measure().asleep, 40u);
        EXPECT_THAT(engine.plan().stages(), testing::IsEmpty());
        EXPECT_THAT(engine.plan().why(Effect::sleep),
                    testing::StartsWith("sleep: on, all strands at rest since "));
    }
    std::uint32_t asleepAfter(const FrameInput& input) {
        engine.step(input);
        return engine.measure().asleep;
    }
};

class Sleep : public testing::TestWithParam<StrandModel> {
  protected:
    static SimulationSettings settings() {
        return GetParam() == StrandModel::rods ? SimulationSettings{} : springSettings();
    }
};
INSTANTIATE_TEST_SUITE_P(Models, Sleep, testing::Values(StrandModel::rods, StrandModel::springs),
                         [](const auto& model) {
                             return model.param == StrandModel::rods ? "rods" : "springs";
                         });

TEST_P(Sleep, LeavesStrandsAtRestAloneUntilSomethingMovesThem) {
    {
        Sleeping hair(settings());
        const std::uint64_t hash = hair.engine.stateHash();
        run(hair.engine, hair.strands, 100);
        EXPECT_EQ(hair.engine.stateHash(), hash) << "asleep, nothing drifts";
    }
    {
        Sleeping hair(settings());
        const auto roots = hair.strands.roots({0.001f, 0.0f, 0.0f});
        EXPECT_EQ(hair.asleepAfter({1.0f / 60.0f, 0.0, roots, {}}), 0u) << "roots";
    }
    {
        Sleeping hair(settings());
        hair.settings.windSpeed = 1.0f;
        ASSERT_EQ(hair.engine.setSettings(hair.settings), "");
        run(hair.engine, hair.strands, 1);
        EXPECT_EQ(hair.engine.measure().asleep, 0u) << "settings and wind";
    }
    {
        Sleeping hair(settings());
        const auto roots = hair.strands.roots();
        const std::vector<Sphere> far{{{9.0f, 0.0f, 0.0f}, 0.1f}}, near{{{0.05f, 0.0f, 0.0f}, 0.1f}};
        EXPECT_EQ(hair.asleepAfter({1.0f / 60.0f, 0.0, roots, far}), 40u) << "far sphere";
        EXPECT_LT(hair.asleepAfter({1.0f / 60.0f, 0.0, roots, near}), 40u) << "near sphere";
    }
}

TEST_P(Sleep, ComesBackAfterAPush) {
    Sleeping hair(settings());
    const std::vector<Float3> push(hair.engine.pointCount(), Float3{0.1f, 0.0f, 0.0f});
    hair.engine.addVelocities(push);
    run(hair.engine, hair.strands, 1);
    EXPECT_EQ(hair.engine.measure().asleep, 0u);
    run(hair.engine, hair.strands, 900);
    EXPECT_EQ(hair.engine.measure().asleep, 40u) << "the last block is not full";
}

TEST(NoSleep, IsASetting) {
    const Strands strands = tuft(5);
    SimulationSettings s = springSettings();
    s.sleepSpeed = 0.0f;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 600);
    EXPECT_EQ(engine.measure().asleep, 0u);
    EXPECT_EQ(engine.plan().why(Effect::sleep), "sleep: off, zero sleep speed");
}

TEST(Recovery, ExplodedStrandsAreResetToRestAndReported) {
    const Strands strands = tuft(5);
    SimulationSettings s = springSettings();
    s.integrator = Integrator::explicitEuler;
    s.lengthMethod = LengthMethod::springs;
    s.lengthIterations = 0;
    s.springFrequency = 5000.0f;
    std::string log;
    Host host;
    host.log = [&](std::string_view text) { log = text; };
    Engine engine = makeEngine(strands, s, host);
    std::uint32_t restored = 0;
    for (int f = 0; f < 60; ++f) {
        run(engine, strands, 1);
        restored += engine.lastStep().restoredStrands;
        EXPECT_EQ(engine.measure().nanCount, 0u) << f;
    }
    EXPECT_GT(restored, 0u);
    EXPECT_THAT(log, testing::HasSubstr("put back to rest"));
}

TEST(Velocities, CanBeChangedBetweenFrames) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, 0.05f, 3);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 1);
    const std::vector<Float3> changes{{1, 1, 1}, {0.0f, 0.3f, 0.0f}, {std::nanf(""), 0.0f, 0.0f}};
    engine.addVelocities(changes);
    std::vector<Float3> v(3);
    engine.readVelocities(v);
    EXPECT_EQ(v[0], Float3{});
    EXPECT_NEAR(v[1].y, 0.3f, 1e-4f);
    EXPECT_EQ(v[2], Float3{});
    run(engine, strands, 60);
    EXPECT_NEAR(positionsOf(engine)[1].y, 0.3f, 1e-3f) << "a second at 0.3 m/s";
}

/// Curls of radius r about a vertical axis.
Strands curls(float radius) {
    Strands strands;
    for (std::uint32_t s = 0; s < 8; ++s) {
        Float3 at{0.02f * static_cast<float>(s), 0.0f, 0.0f};
        for (std::uint32_t p = 0; p < 24; ++p) {
            strands.points.push_back(at);
            const float turn = static_cast<float>(s) + 0.6f * static_cast<float>(p);
            const Float3 way{-std::sin(turn), -0.5f, std::cos(turn)};
            at = at + way * (0.7f * radius / length(way));
        }
        strands.offsets.push_back(static_cast<std::uint32_t>(strands.points.size()));
    }
    return strands;
}

TEST(Curls, ComeToRestAfterBeingShaken) {
    for (const float radius : {0.002f, 0.005f, 0.02f}) {
        const Strands strands = curls(radius);
        SimulationSettings s;
        s.sleepSpeed = 0.0f;
        s.angularStiffness = 0.5f;
        Engine engine = makeEngine(strands, s);
        double shaken = 0.0;
        for (int f = 0; f < 60; ++f) {
            const float t = static_cast<float>(f);
            const auto roots = strands.roots({0.05f * std::sin(0.8f * t), 0.0f, 0.0f},
                                             turnAbout({0.0f, 1.0f, 0.0f}, 0.5f * std::sin(0.5f * t)));
            engine.step({1.0f / 60.0f, f / 60.0, roots, {}});
            shaken = std::max(shaken, engine.measure().kineticEnergy);
        }
        run(engine, strands, 300);
        EXPECT_LT(engine.measure().kineticEnergy, 0.01 * shaken) << radius;
        EXPECT_LT(engine.measure().maxStretch, 0.01) << radius;
    }
}

}  // namespace
}  // namespace hairloom::runtime
