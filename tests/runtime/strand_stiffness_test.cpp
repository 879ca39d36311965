// SPDX-License-Identifier: GPL-3.0-or-later
// Strands of their own stiffness: each bends as if the settings had it, beside whatever others.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "engine/state.h"
#include "hairloom/alternatives/projective_equations.h"
#include "hairloom/alternatives/rigid_chains.h"
#include "hairloom/presets.h"
#include "hairloom/stable.h"
#include "tests/runtime/segment_methods.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/simulation/elastica.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr double kGravity = 9.81;
constexpr float kLength = 0.1f;  // metres that are free to bend

/// Equally stiff everywhere, shapes without load, and nothing that falls asleep on its way down.
SimulationSettings settingsOf(StrandModel model, double B) {
    SimulationSettings s = model == StrandModel::springs ? springSettings() : SimulationSettings();
    s.strandModel = model;
    s.angularStiffness = angularStiffnessOf(B);
    s.angularCurve = {};
    s.restGravity = 0.0f;
    s.sleepSpeed = 0.0f;
    s.gravity = {0.0f, -static_cast<float>(kGravity), 0.0f};
    return s;
}
constexpr StrandModel kModels[] = {StrandModel::rods, StrandModel::springs};

/// Level strands side by side, whose first segment is clamped.
Strands levelStrands(std::vector<float> stiffness, std::uint32_t segments = 32) {
    Strands strands;
    for (std::size_t s = 0; s < stiffness.size(); ++s)
        strands.add({0.0f, 0.0f, 0.01f * static_cast<float>(s)}, {1.0f, 0.0f, 0.0f},
                    kLength / static_cast<float>(segments), segments + 2);
    strands.stiffness = std::move(stiffness);
    return strands;
}

/// A helix of 8 mm that hangs from the origin.
std::vector<Float3> curl(std::uint32_t turns, std::uint32_t pointsPerTurn) {
    std::vector<Float3> points;
    for (std::uint32_t p = 0; p <= turns * pointsPerTurn; ++p) {
        const float angle =
            2.0f * std::numbers::pi_v<float> * static_cast<float>(p) / static_cast<float>(pointsPerTurn);
        points.push_back({0.008f * (std::cos(angle) - 1.0f),
                          -0.02f * static_cast<float>(p) / static_cast<float>(pointsPerTurn),
                          0.008f * std::sin(angle)});
    }
    return points;
}

double fastestOf(const Engine& engine) {
    std::vector<Float3> velocities(engine.pointCount());
    engine.readVelocities(velocities);
    double fastest = 0.0;
    for (const Float3 v : velocities) fastest = std::max(fastest, static_cast<double>(length(v)));
    return fastest;
}

TEST(StrandStiffness, EachStrandRestsOnTheElasticaOfItsOwn) {
    const double B = test::elasticaStiffness(0.4, kGravity, static_cast<double>(kLength));
    const std::vector<float> factors{8.0f, 2.0f, 1.0f, 0.25f};
    for (const StrandModel model : kModels) {
        // The joint at the clamp of a rod stands for all of the clamped segment.
        constexpr float kSegment = kLength / 32;
        const float clamped = model == StrandModel::springs ? kSegment : 0.0f;
        const double bends = static_cast<double>(kLength + kSegment - clamped);
        const Strands strands = levelStrands(factors);
        Engine engine = makeEngine(strands, settingsOf(model, B));
        run(engine, strands, 2400);
        const std::vector<Float3> now = positionsOf(engine);
        double dropBefore = 0.0;
        for (std::size_t s = 0; s < factors.size(); ++s) {
            const auto exact = test::solveElastica(B * static_cast<double>(factors[s]), kGravity, bends);
            EXPECT_GT(exact.drop, dropBefore + 0.005) << "tells them apart";
            dropBefore = exact.drop;
            const Float3 tip = now[strands.offsets[s + 1] - 1];
            const double x = static_cast<double>(tip.x - clamped) - exact.reach,
                         y = static_cast<double>(tip.y) + exact.drop;
            EXPECT_LT(std::hypot(x, y), 0.02 * bends)
                << "factor " << factors[s] << ", model " << static_cast<int>(model);
        }
    }
}

TEST(StrandStiffness, CurlsTwistAndBendAsIfTheSettingsHadIt) {
    constexpr float kFactor = 3.0f;
    for (const float ratio : {1.0f, 0.5f}) {
        SimulationSettings s = settingsOf(StrandModel::rods, kHairBendingStiffness);
        s.sectionRatio = ratio;
        Strands own;
        own.add(curl(4, 24));
        own.stiffness = {kFactor};
        Engine engine = makeEngine(own, s);
        SimulationSettings stiffer = s;
        stiffer.angularStiffness = angularStiffnessOf(static_cast<double>(kFactor) * kHairBendingStiffness);
        Strands plain = own;
        plain.stiffness.clear();
        Engine expected = makeEngine(plain, stiffer), softer = makeEngine(plain, s);
        run(engine, own, 300);
        run(expected, plain, 300);
        run(softer, plain, 300);
        double apart = 0.0, told = 0.0;
        for (std::uint32_t p = 0; p < engine.pointCount(); ++p) {
            const auto off = [&](const Engine& other) {
                return static_cast<double>(length(positionsOf(engine)[p] - positionsOf(other)[p]));
            };
            apart = std::max(apart, off(expected));
            told = std::max(told, off(softer));
        }
        EXPECT_LT(apart, 2e-5) << "section " << ratio;
        EXPECT_GT(told, 2e-3) << "section " << ratio;
    }
}

TEST(StrandStiffness, OneEverywhereIsNone) {
    Strands plain = tuft(40, true), ones = plain;
    ones.stiffness.assign(plain.count(), 1.0f);
    EXPECT_EQ(makeRestShape(ones.view())->bytes(), makeRestShape(plain.view())->bytes());
    for (const StrandModel model : kModels) {
        const SimulationSettings s = settingsOf(model, kHairBendingStiffness);
        Engine a = makeEngine(plain, s), b = makeEngine(ones, s);
        run(a, plain, 30);
        run(b, ones, 30);
        EXPECT_EQ(a.stateHash(), b.stateHash());
    }
}

TEST(StrandStiffness, StrandsBesideOthersMoveAsIfTheyWereAlone) {
    Strands mixed = tuft(40, true);
    for (std::uint32_t s = 0; s < mixed.count(); ++s)
        mixed.stiffness.push_back(s % 3 == 0 ? 0.0f : s % 3 == 1 ? 1.0f : kMostStiffness);
    for (const StrandModel model : kModels) {
        SimulationSettings s = settingsOf(model, kHairBendingStiffness);
        s.restGravity = 1.0f;
        Engine together = makeEngine(mixed, s);
        run(together, mixed, 60);
        const std::vector<Float3> all = positionsOf(together);
        for (const std::uint32_t one : {0u, 1u, 2u, 36u, 37u, 38u}) {
            Strands alone;
            alone.add(
                {mixed.points.begin() + mixed.offsets[one], mixed.points.begin() + mixed.offsets[one + 1]});
            alone.stiffness = {mixed.stiffness[one]};
            Engine engine = makeEngine(alone, s);
            run(engine, alone, 60);
            const std::vector<Float3> own = positionsOf(engine);
            for (std::size_t p = 0; p < own.size(); ++p)
                ASSERT_EQ(own[p], all[mixed.offsets[one] + p]) << "strand " << one << ", point " << p;
        }
    }
}

/// A strand that nothing stiffens is a chain: it hangs straight down from its clamp, whatever it was.
TEST(StrandStiffness, WithoutAnyAStrandHangsLimp) {
    for (const StrandModel model : kModels) {
        for (const float restGravity : {0.0f, 1.0f}) {
            SimulationSettings s = settingsOf(model, kHairBendingStiffness);
            s.restGravity = restGravity;
            const Strands strands = levelStrands({0.0f, 1.0f}, 16);
            Engine engine = makeEngine(strands, s);
            run(engine, strands, 1200);
            const std::vector<Float3> now = positionsOf(engine);
            const Float3 tip = now[strands.offsets[1] - 1];
            EXPECT_NEAR(tip.y, -kLength, 2e-3f) << static_cast<int>(model) << ", carried " << restGravity;
            EXPECT_GT(now.back().y, -0.8f * kLength) << "the one beside it is not";
            EXPECT_LT(fastestOf(engine), 0.01);
        }
    }
}

/// Limp, soft and most stiff rods side by side through motion that no head makes.
TEST(StrandStiffness, NoStormBreaksLimpStrandsAmongStiffOnes) {
    std::mt19937 random(5);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    for (int storm = 0; storm < 24; ++storm) {
        SimulationSettings s = settingsOf(StrandModel::rods, kHairBendingStiffness);
        s.substeps = 1 + random() % 4;
        s.restGravity = static_cast<float>(random() % 2);
        s.clampedPoints = 1 + random() % 2;
        s.bendDampingTime = random() % 2 ? 0.03f : 0.0f;
        if (storm % 3 == 0) s.sectionRatio = 0.5f;
        if (storm % 5 == 0) s.angularStiffness = 1.0f;
        s.teleportDistance = 10000.0f;
        Strands strands = tuft(8);
        for (int i = 0; i < 4; ++i) strands.add(curl(3, 12));
        for (std::uint32_t i = 0; i < strands.count(); ++i)
            strands.stiffness.push_back(std::array{0.0f, 1e-6f, 1.0f, kMostStiffness}[i % 4]);
        Engine engine = makeEngine(strands, s);
        std::vector<Sphere> spheres(2, Sphere{{}, 0.05f});
        Float3 shift;
        for (int frame = 0; frame < 90; ++frame) {
            if (random() % 4 == 0) shift = {between(-1.0f, 1.0f), between(-1.0f, 1.0f), between(-1.0f, 1.0f)};
            for (Sphere& sphere : spheres)
                sphere.center_ws =
                    shift + Float3{between(-0.2f, 0.2f), between(-0.2f, 0.2f), between(-0.2f, 0.2f)};
            const auto roots = strands.roots(shift, turnAbout({0.0f, 1.0f, 0.0f}, between(-2.0f, 2.0f)));
            FrameInput input{1.0f / 60.0f, static_cast<double>(frame), roots, spheres};
            if (random() % 2) input.wind_ws = Float3{between(-50.0f, 50.0f), 0.0f, between(-50.0f, 50.0f)};
            engine.step(input);
            ASSERT_EQ(engine.measure().nanCount, 0u) << "storm " << storm << ", frame " << frame;
            ASSERT_EQ(engine.lastStep().restoredStrands, 0u) << "storm " << storm << ", frame " << frame;
        }
        run(engine, strands, 300);
        EXPECT_EQ(engine.measure().nanCount, 0u);
        EXPECT_LT(fastestOf(engine), 0.5) << "storm " << storm;
    }
}

TEST(StrandStiffness, LimpStrandsStandInAPose) {
    const Strands strands = levelStrands({0.0f, 1.0f}, 16);
    Engine engine = makeEngine(strands, settingsOf(StrandModel::rods, kHairBendingStiffness));
    std::vector<Float3> upright;
    for (std::size_t p = 0; p < strands.points.size(); ++p) {
        const Float3 at = strands.points[p];
        // Beyond the clamp it goes up at 45 degrees.
        const float free = std::max(0.0f, at.x - kLength / 16);
        upright.push_back({at.x - free + free * std::sqrt(0.5f), free * std::sqrt(0.5f), at.z});
    }
    const PoseView pose{upright, {}};
    ASSERT_EQ(engine.setPoses({&pose, 1}), "");
    const float amount = 1.0f;
    ASSERT_TRUE(engine.setPoseAmounts({&amount, 1}));
    run(engine, strands, 300);
    const std::vector<Float3> now = positionsOf(engine);
    for (std::size_t p = 0; p < now.size(); ++p)
        ASSERT_LT(length(now[p] - upright[p]), 1e-3f) << "point " << p;
}

TEST(StrandStiffness, TheStiffestStrandDecidesTheLongestStep) {
    SimulationSettings s = settingsOf(StrandModel::springs, kHairBendingStiffness);
    s.angularMethod = AngularMethod::smallAngle;
    const double even = fastestWaves(levelStrands({1.0f, 1.0f}).view(), s).bending;
    const double stiff = fastestWaves(levelStrands({1.0f, 9.0f}).view(), s).bending;
    EXPECT_NEAR(stiff / even, 3.0, 1e-3);
}

template <class Method>
void expectOwnStiffness() {
    const Strands own = levelStrands({4.0f, 1.0f, 0.0f}, 16);
    Strands plain = levelStrands({1.0f, 1.0f}, 16);
    plain.stiffness.clear();
    const SimulationSettings s = settingsOf(StrandModel::rods, kHairBendingStiffness);
    Method mixed = makeMethod<Method>(own, s);
    Method soft = makeMethod<Method>(plain, s);
    Method stiff = makeMethod<Method>(plain, settingsOf(StrandModel::rods, 4.0 * kHairBendingStiffness));
    run(mixed, own, 30);
    run(soft, plain, 30);
    run(stiff, plain, 30);
    const Float3 stiffTip = positionsOf(mixed)[own.offsets[1] - 1],
                 softTip = positionsOf(mixed)[own.offsets[2] - 1];
    EXPECT_LT(length(stiffTip - positionsOf(stiff)[own.offsets[1] - 1]), 1e-5f);
    EXPECT_LT(length(softTip - positionsOf(soft)[own.offsets[2] - 1]), 1e-5f);
    EXPECT_GT(length(positionsOf(stiff)[own.offsets[1] - 1] - positionsOf(soft)[own.offsets[1] - 1]), 1e-4f);
    EXPECT_TRUE(isFinite(positionsOf(mixed).back()));
    EXPECT_LT(positionsOf(mixed).back().y, softTip.y);
}

TEST(StrandStiffness, RigidChainsAndProjectiveEquationsHaveIt) {
    expectOwnStiffness<RigidChains>();
    expectOwnStiffness<ProjectiveEquations>();
}

TEST(StrandStiffness, RefusesWhatIsNone) {
    const auto errorOf = [](std::vector<float> stiffness) {
        Strands strands = levelStrands({1.0f, 1.0f}, 4);
        strands.stiffness = std::move(stiffness);
        return Engine::make(strands.view(), SimulationSettings()).error;
    };
    EXPECT_EQ(errorOf({0.0f, kMostStiffness}), "");
    EXPECT_EQ(errorOf({1.0f}), "1 values of stiffness for 2 strands; expected none or one each");
    EXPECT_EQ(errorOf({1.0f, -1.0f}), "stiffness of strand 1 is -1; expected 0 to 1000");
    EXPECT_EQ(errorOf({1001.0f, 1.0f}), "stiffness of strand 0 is 1001; expected 0 to 1000");
    EXPECT_EQ(errorOf({1.0f, std::numeric_limits<float>::quiet_NaN()}),
              "stiffness of strand 1 is nan; expected 0 to 1000");
}

}  // namespace
}  // namespace hairloom::runtime
