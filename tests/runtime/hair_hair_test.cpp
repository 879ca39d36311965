// SPDX-License-Identifier: GPL-3.0-or-later
// Hair against hair inside the step: a ball of soft radial hair on a sphere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

constexpr float kHead = 0.1f, kHair = 0.12f;  // metres: radius, length
constexpr std::uint32_t kPoints = 12;

struct Ball {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> points, directions;

    explicit Ball(std::uint32_t count) {
        for (std::uint32_t s = 0; s < count; ++s) {
            const float y = 1.0f - 1.3f * (static_cast<float>(s) + 0.5f) / static_cast<float>(count);
            const float r = std::sqrt(1.0f - y * y), angle = 2.399963f * static_cast<float>(s);
            const Float3 out{r * std::cos(angle), y, r * std::sin(angle)};
            directions.push_back(out);
            for (std::uint32_t p = 0; p < kPoints; ++p)
                points.push_back(out * (kHead + kHair * static_cast<float>(p) / (kPoints - 1)));
            offsets.push_back(static_cast<std::uint32_t>(points.size()));
        }
    }
    Engine engine(const SimulationSettings& settings, Host host = {}) const {
        Engine::Result made = Engine::make({offsets, points}, settings, std::move(host));
        EXPECT_EQ(made.error, "");
        return std::move(*made.engine);
    }
    void run(Engine& engine, int first, int last, float nod = 0.0f) const {
        const Sphere head{{}, kHead};
        for (int f = first; f < last; ++f) {
            // −0 would be another root than 0.
            const float angle = nod > 0.0f ? nod * std::sin(0.2f * static_cast<float>(f)) : 0.0f;
            const Quat turn = turnAbout({1.0f, 0.0f, 0.0f}, angle);
            std::vector<RootFrame> roots;
            for (const Float3 out : directions) roots.push_back({rotate(turn, out * kHead), turn});
            engine.step({.time = f / 60.0, .roots_ws = roots, .spheres = {&head, 1}});
        }
    }
    double thickness(const Engine& engine) const {
        const std::vector<Float3> at = positionsOf(engine);
        double sum = 0.0;
        for (std::size_t s = 1; s < offsets.size(); ++s) sum += length(at[offsets[s] - 1]) - kHead;
        return sum / (kHair * static_cast<double>(directions.size()));
    }
};

/// Hair that gravity presses down, since its shape does not carry its weight.
SimulationSettings soft(bool on) {
    SimulationSettings s;
    s.angularStiffness = 0.3f;
    s.restGravity = 0.0f;
    s.hairHair = on;
    return s;
}

TEST(HairHair, SoftHairKeepsItsThickness) {
    const Ball ball(300);
    Engine with = ball.engine(soft(true)), without = ball.engine(soft(false));
    ball.run(with, 1, 240);
    ball.run(without, 1, 240);
    EXPECT_LT(ball.thickness(without), 0.45);
    EXPECT_GT(ball.thickness(with), 0.75);
    EXPECT_EQ(with.measure().nanCount, 0u);
    EXPECT_LE(with.measure().maxPenetration, without.measure().maxPenetration + 1e-4);
    EXPECT_LT(with.measure().fastest, 0.03);
    ball.run(with, 240, 420);
    EXPECT_GT(with.asleep(), 100u);
}

/// Speed, height and what bends and presses hair are all paid by the height at which it starts.
TEST(HairHair, EnergyIsNeverAboveWhatWasPutIn) {
    const Ball ball(500);
    for (const float strength : {0.2f, 0.5f, 1.0f}) {
        SimulationSettings s = soft(true);
        s.hairHairStrength = strength;
        Engine engine = ball.engine(s);
        const auto energy = [&] {
            const Measurements now = engine.measure();
            return now.kineticEnergy + now.potentialEnergy;
        };
        const double start = energy();
        for (int f = 1; f < 120; ++f) {
            ball.run(engine, f, f + 1);
            ASSERT_LE(energy(), start + 1e-3) << f;
        }
        EXPECT_LT(energy(), start - 1.0);
    }
}

/// Turned over, and after a shake.
TEST(HairHair, SoftHairKeepsItsThicknessUpsideDownAndAfterAShake) {
    const Ball ball(300);
    Engine engine = ball.engine(soft(true));
    ball.run(engine, 1, 90, 0.6f);
    ball.run(engine, 90, 300);
    EXPECT_GT(ball.thickness(engine), 0.65);
    SimulationSettings down = soft(true);
    down.gravity = {0.0f, 9.81f, 0.0f};
    Engine turned = ball.engine(down);
    ball.run(turned, 1, 240);
    EXPECT_GT(ball.thickness(turned), 0.75);
}

/// A style that carries its weight sleeps beside hair against hair as without it.
TEST(HairHair, AStyleThatCarriesItsWeightSleepsAsWithout) {
    const Ball ball(900);
    std::vector<Float3> ends[2];
    for (const bool on : {false, true}) {
        SimulationSettings s;
        s.hairHair = on;
        Engine engine = ball.engine(s);
        ball.run(engine, 1, 60);
        EXPECT_EQ(engine.asleep(), 900u) << on;
        ends[on ? 1 : 0] = positionsOf(engine);
    }
    for (std::size_t i = 0; i < ends[0].size(); ++i) EXPECT_LT(length(ends[0][i] - ends[1][i]), 1e-4f) << i;
}

TEST(HairHair, OtherCellsLeaveSleepersWhereTheyAre) {
    const Ball ball(900);
    SimulationSettings s;
    s.hairHair = true;
    Engine engine = ball.engine(s);
    ball.run(engine, 1, 60);
    ASSERT_EQ(engine.asleep(), 900u);
    const auto before = positionsOf(engine);
    for (const float cell : {0.03f, 0.011f, 0.0f}) {
        s.hairHairCell = cell;
        ASSERT_EQ(engine.setSettings(s), "");
        ball.run(engine, 61, 120);
        EXPECT_EQ(engine.asleep(), 900u) << cell;
        const auto after = positionsOf(engine);
        for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT(length(after[i] - before[i]), 1e-4f) << i;
    }
}

TEST(HairHair, AStyleAtRestFeelsNoneOfItAndSleeps) {
    const Ball ball(300);
    SimulationSettings s;
    s.gravity = {};
    const auto after = [&](bool on, float angle) {
        s.hairHair = on;
        Engine engine = ball.engine(s);
        const Quat turn = turnAbout({0.6f, 0.0f, 0.8f}, angle);
        std::vector<RootFrame> roots;
        for (const Float3 out : ball.directions)
            roots.push_back({rotate(turn, out * kHead) + Float3{3.0f, 1.0f, -2.0f}, turn});
        engine.reset(roots);
        for (int f = 1; f < 60; ++f) engine.step({.time = f / 60.0, .roots_ws = roots});
        EXPECT_EQ(engine.asleep(), 300u);
        return positionsOf(engine);
    };
    for (const float angle : {0.0f, 1.1f, 3.0f}) {
        const auto on = after(true, angle), off = after(false, angle);
        for (std::size_t i = 0; i < on.size(); ++i) EXPECT_LT(length(on[i] - off[i]), 1e-5f) << i;
    }
}

TEST(HairHair, SameBitsOnAnyThreadsAndFromASnapshot) {
    const Ball ball(700);
    const auto hashOf = [&](Host host) {
        Engine engine = ball.engine(soft(true), std::move(host));
        ball.run(engine, 1, 30, 0.5f);
        Engine copy = engine;
        ball.run(engine, 30, 45, 0.5f);
        ball.run(copy, 30, 45, 0.5f);
        EXPECT_EQ(engine.stateHash(), copy.stateHash());
        return engine.stateHash();
    };
    const std::uint64_t serial = hashOf({});
    for (const unsigned threads : {1u, 2u, 7u})
        EXPECT_EQ(hashOf(hostWithThreads(threads)), serial) << threads;
    EXPECT_EQ(hashOf(hostWithThreads(3, true)), serial);
}

TEST(HairHair, OffCostsNothingAndSpringsDoNotMeetHair) {
    const Ball ball(40);
    Engine off = ball.engine(soft(false));
    EXPECT_EQ(off.effectBytes(Effect::hairHair), 0u);
    Engine on = ball.engine(soft(true));
    ball.run(on, 1, 3);
    EXPECT_TRUE(on.plan().on(Effect::hairHair)) << on.plan().why(Effect::hairHair);
    EXPECT_GT(on.effectBytes(Effect::hairHair), 0u);
    EXPECT_EQ(on.setSettings(soft(false)), "");
    EXPECT_EQ(on.effectBytes(Effect::hairHair), 0u);
    SimulationSettings springs = soft(true);
    springs.strandModel = StrandModel::springs;
    EXPECT_EQ(ball.engine(springs).plan().why(Effect::hairHair), "hairHair: off, springs do not meet hair");
}

/// One hair, a groom kilometres wide, and hair that is flung away.
TEST(HairHair, HardInputStaysFiniteAndWithinItsMemory) {
    Ball one(1), wide(200);
    for (std::size_t i = 0; i < wide.points.size(); ++i)
        wide.points[i].x += 20.0f * static_cast<float>(i / kPoints);
    SimulationSettings s = soft(true);
    s.hairHairCell = 0.001f;
    s.hairHairStrength = 1.0f;
    s.hairHairFriction = 100.0f;
    s.hairHairCohesion = 100.0f;
    for (const Ball* ball : {&one, &wide}) {
        Engine engine = ball->engine(s);
        ball->run(engine, 1, 20, 0.3f);
        EXPECT_EQ(engine.measure().nanCount, 0u);
        EXPECT_LT(engine.effectBytes(Effect::hairHair), std::size_t{32} << 20);
        std::vector<Float3> fast(ball->points.size(), Float3{90.0f, 300.0f, -20.0f});
        fast[3].x = std::numeric_limits<float>::quiet_NaN();
        engine.addVelocities(fast);
        ball->run(engine, 20, 40, 1.0f);
        EXPECT_EQ(engine.measure().nanCount, 0u);
    }
}

}  // namespace
}  // namespace hairloom::runtime
