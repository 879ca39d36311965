// SPDX-License-Identifier: GPL-3.0-or-later
// Tapered capsules: their geometry against a search over all their spheres, and strands of each model on
// them.
#include "hairloom/capsules.h"

#include <algorithm>

#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

constexpr float kStep = 1.0f / 60.0f;

Sphere mixed(const Sphere& a, const Sphere& b, float share) {
    return {a.center_ws * (1.0f - share) + b.center_ws * share, a.radius * (1.0f - share) + b.radius * share};
}
float depthIn(const Sphere& sphere, Float3 place) {
    return sphere.radius - length(place - sphere.center_ws);
}
/// By search: the deepest of many spheres between the ends.
float depthBySearch(const Sphere& a, const Sphere& b, Float3 place) {
    float deepest = -1e30f;
    for (int i = 0; i <= 20000; ++i)
        deepest = std::max(deepest, depthIn(mixed(a, b, static_cast<float>(i) / 20000.0f), place));
    return deepest;
}

struct Hull {
    Sphere first, second;
};
std::vector<Hull> hulls() {
    return {{{{0, 0, 0}, 0.04f}, {{0.2f, 0, 0}, 0.04f}},
            {{{0, 0, 0}, 0.08f}, {{0.1f, 0.1f, 0.05f}, 0.02f}},
            {{{0.3f, -0.1f, 0}, 0.01f}, {{0, 0, 0.2f}, 0.09f}},
            {{{0, 0, 0}, 0.1f}, {{0.02f, 0, 0}, 0.05f}},
            {{{0, 0, 0}, 0.05f}, {{0.02f, 0.01f, 0}, 0.0501f}},
            {{{0, 0, 0}, 0.05f}, {{0, 0, 0}, 0.05f}}};
}

TEST(Capsules, TheNearestSphereIsTheDeepestOfAllBetweenTheEnds) {
    for (const auto& [first, second] : hulls()) {
        for (int i = 0; i < 60; ++i) {
            const float f = static_cast<float>(i);
            const Float3 place{0.25f * std::sin(f), 0.2f * std::cos(1.7f * f), 0.2f * std::sin(2.3f * f)};
            EXPECT_NEAR(depthIn(nearestOfCapsule(first, second, place), place),
                        depthBySearch(first, second, place), 2e-6f)
                << i;
        }
        // On the axis no way out is nearer than another.
        EXPECT_NEAR(depthIn(nearestOfCapsule(first, second, first.center_ws), first.center_ws),
                    depthBySearch(first, second, first.center_ws), 2e-6f);
    }
}

TEST(Capsules, SpheresAlongOneLieHalfAMillimetreBelowItAtMost) {
    for (const auto& [first, second] : hulls()) {
        std::vector<Sphere> spheres{first, second};
        appendCapsules(std::vector<Capsule>{{0, 1}}, spheres);
        ASSERT_LE(spheres.size(), 2 + kMaxAlongCapsule);
        if (spheres.size() == 2 + kMaxAlongCapsule) continue;  // too few for the bound
        for (int i = 0; i <= 400; ++i) {
            // From a place on the axis straight out to the surface.
            const float f = static_cast<float>(i);
            const Float3 out{std::sin(f), std::cos(1.7f * f), std::sin(2.3f * f)};
            Float3 place = mixed(first, second, f / 400.0f).center_ws;
            for (int k = 0; k < 200; ++k) {
                const float depth = depthIn(nearestOfCapsule(first, second, place), place);
                if (std::abs(depth) < 1e-6f) break;
                place = place + out * (depth / length(out));
            }
            float deepest = -1e30f;
            for (const Sphere& sphere : spheres) deepest = std::max(deepest, depthIn(sphere, place));
            EXPECT_LE(deepest, 1e-5f) << i;
            EXPECT_GE(deepest, -6e-4f) << i;
        }
    }
}

TEST(Capsules, WhatJoinsNothingAddsNothing) {
    std::vector<Sphere> spheres{{{0, 0, 0}, 0.05f}, {{0.3f, 0, 0}, 0.0f}, {{0.6f, 0, 0}, 0.05f}};
    appendCapsules(std::vector<Capsule>{{0, 0}, {0, 1}, {0, 7}, {9, 2}}, spheres);
    EXPECT_EQ(spheres.size(), 3u);
    appendCapsules(std::vector<Capsule>{{0, 2}}, spheres);
    EXPECT_EQ(spheres.size(), 3u + countAlongCapsule(spheres[0], spheres[2]));
}

SimulationSettings onBar(StrandModel model) {
    SimulationSettings s = model == StrandModel::rods ? SimulationSettings{} : springSettings();
    s.strandModel = model;
    s.restGravity = 0.0f;
    s.angularStiffness = 0.05f;
    s.dampingTime = 0.3f;
    s.airDrag = 0.0f;
    s.collisionRadiusRoot = s.collisionRadiusTip = 0.0f;
    return s;
}

/// Level strands above a bar that lies across them.
Strands levelStrands(std::uint32_t count) {
    Strands strands;
    for (std::uint32_t i = 0; i < count; ++i)
        strands.add({0.0f, 0.0f, 0.01f * static_cast<float>(i)}, {1, 0, 0}, 0.0125f, 17);
    return strands;
}
const std::vector<Sphere> kBar{{{0.09f, -0.08f, -0.06f}, 0.05f}, {{0.09f, -0.07f, 0.15f}, 0.04f}};
const std::vector<Capsule> kOne{{0, 1}};

void step(Engine& engine, const Strands& strands, int frame, std::span<const Sphere> spheres,
          std::span<const Capsule> capsules) {
    const auto roots = strands.roots();
    FrameInput input;
    input.dt = kStep;
    input.time = frame / 60.0;
    input.roots_ws = roots;
    input.spheres = spheres;
    input.capsules = capsules;
    engine.step(input);
}

TEST(Capsules, StrandsOfBothModelsRestOnOne) {
    const Strands strands = levelStrands(12);  // z 0 to 0.11: between both ends, beyond either sphere
    for (const StrandModel model : {StrandModel::rods, StrandModel::springs}) {
        Engine on = makeEngine(strands, onBar(model)), off = makeEngine(strands, onBar(model));
        for (int f = 1; f <= 240; ++f) {
            step(on, strands, f, kBar, kOne);
            step(off, strands, f, {}, {});
        }
        float deepest = -1.0f, apart = 0.0f;
        const auto x = positionsOf(on), free = positionsOf(off);
        for (std::size_t p = 0; p < x.size(); ++p) {
            deepest = std::max(deepest, depthIn(nearestOfCapsule(kBar[0], kBar[1], x[p]), x[p]));
            apart = std::max(apart, length(x[p] - free[p]));
        }
        EXPECT_GT(apart, 0.05f) << "without one they hang down";
        EXPECT_LT(deepest, 0.001f) << static_cast<int>(model);
        EXPECT_GT(deepest, -0.001f) << "they lie on it";
        EXPECT_LT(on.measure().fastest, model == StrandModel::rods ? 0.005 : 0.02);
        EXPECT_NEAR(on.measure().maxPenetration, static_cast<double>(deepest), 1e-5);
    }
}

TEST(Capsules, OneThatASphereHoldsIsThatSphereToTheBit) {
    const Strands strands = levelStrands(9);
    const std::vector<Sphere> ball{{{0.09f, -0.06f, 0.04f}, 0.05f}};
    const std::vector<Sphere> nested{ball[0], {{0.1f, -0.06f, 0.04f}, 0.02f}};
    Engine one = makeEngine(strands, onBar(StrandModel::rods)),
           other = makeEngine(strands, onBar(StrandModel::rods));
    for (int f = 1; f <= 60; ++f) {
        step(one, strands, f, ball, {});
        step(other, strands, f, nested, kOne);
        ASSERT_EQ(one.stateHash(), other.stateHash()) << f;
    }
}

TEST(Capsules, OneThatComesFastIsMetAndNotPassed) {
    // 12 cm in each of two substeps, through a bar of 2 cm: with its end spheres alone it would be missed.
    const Strands strands = levelStrands(6);
    SimulationSettings s = onBar(StrandModel::rods);
    s.gravity = {};
    s.teleportDistance = 10.0f;
    s.substeps = 2;
    Engine engine = makeEngine(strands, s);
    for (int f = 0; f <= 3; ++f) {
        const float y = 0.3f - 0.24f * static_cast<float>(f);
        const std::vector<Sphere> bar{{{0.15f, y, -0.1f}, 0.02f}, {{0.15f, y, 0.2f}, 0.02f}};
        step(engine, strands, f + 1, bar, kOne);
    }
    for (const Float3& x : positionsOf(engine)) ASSERT_TRUE(isFinite(x));
    const auto x = positionsOf(engine);
    for (std::uint32_t strand = 0; strand < 6; ++strand)
        EXPECT_LT(x[17 * strand + 16].y, -0.05f) << "it has taken the tips along";
}

/// Hair that has fallen asleep on a bar whose ends are out of its reach.
class OnABar : public testing::Test {
  protected:
    OnABar() : engine_(makeEngine(strands_, onBar(StrandModel::rods))) {
        for (int f = 0; f < 1200 && engine_.asleep() < 16; ++f) frame(ends_, kOne);
        EXPECT_EQ(engine_.asleep(), 16u);
        frame(ends_, kOne);
        EXPECT_EQ(engine_.asleep(), 16u);
    }
    void frame(std::span<const Sphere> spheres, std::span<const Capsule> capsules) {
        step(engine_, strands_, ++frame_, spheres, capsules);
    }

    const std::vector<Sphere> ends_{{{0.09f, -0.08f, -0.5f}, 0.05f}, {{0.09f, -0.08f, 0.6f}, 0.05f}};
    Strands strands_ = levelStrands(16);
    Engine engine_;
    int frame_ = 0;
};

TEST_F(OnABar, SleepingHairWakesWhenAnEndMovesFarAway) {
    std::vector<Sphere> moved = ends_;
    moved[1].center_ws.x += 0.01f;
    frame(moved, kOne);
    EXPECT_EQ(engine_.asleep(), 0u);
}

TEST_F(OnABar, SleepingHairFallsWhenItIsUnjoinedAndWhenItsEndsAreGone) {
    Engine other(engine_);
    frame(ends_, {});
    EXPECT_EQ(engine_.asleep(), 0u);
    const auto roots = strands_.roots();
    FrameInput nothing;
    nothing.dt = kStep;
    nothing.roots_ws = roots;
    other.step(nothing);
    EXPECT_EQ(other.asleep(), 0u);
}

TEST_F(OnABar, SleepingHairIsWokenByABarThatAppears) {
    for (int f = 0; f < 1200 && (f < 3 || engine_.asleep() < 16); ++f) frame(ends_, {});
    ASSERT_EQ(engine_.asleep(), 16u);
    frame(ends_, {});
    EXPECT_EQ(engine_.asleep(), 16u);
    frame(ends_, kOne);
    EXPECT_EQ(engine_.asleep(), 0u);
}

TEST_F(OnABar, WhatGoesWithItStaysOnIt) {
    // Roots and bar go along together, 4 cm in each substep: to each other they rest.
    const auto start = positionsOf(engine_);
    for (const Float3 way :
         {Float3{0.05f, -0.06f, 0.0f}, Float3{0.0f, 0.03f, 0.07f}, Float3{0.06f, 0.0f, 0.05f}}) {
        Engine going(engine_);
        for (int f = 1; f <= 6; ++f) {
            const Float3 shift = way * static_cast<float>(f);
            std::vector<RootFrame> roots = strands_.roots();
            for (RootFrame& root : roots) root.position = root.position + shift;
            std::vector<Sphere> bar = ends_;
            for (Sphere& end : bar) end.center_ws = end.center_ws + shift;
            FrameInput input;
            input.dt = kStep;
            input.roots_ws = roots;
            input.spheres = bar;
            input.capsules = kOne;
            going.step(input);
            float deepest = -1.0f;
            for (const Float3& x : positionsOf(going))
                deepest = std::max(deepest, depthIn(nearestOfCapsule(bar[0], bar[1], x), x));
            EXPECT_LT(deepest, 0.005f) << f;  // from rest to 5 m/s at once
        }
    }
}

TEST(Capsules, ThoseThatCannotBeUsedAreCountedAndLeftOut) {
    const Strands strands = levelStrands(8);
    Engine engine = makeEngine(strands, onBar(StrandModel::rods)),
           plain = makeEngine(strands, onBar(StrandModel::rods));
    std::vector<Sphere> spheres = kBar;
    spheres.push_back({{0, 0, 0}, std::nanf("")});
    const std::vector<Capsule> wrong{{0, 0}, {0, 2}, {1, 9}};
    step(engine, strands, 1, spheres, wrong);
    step(plain, strands, 1, spheres, {});
    EXPECT_EQ(engine.lastStep().rejectedSpheres, 1u) << "the sphere that is none";
    EXPECT_EQ(plain.lastStep().rejectedSpheres, 1u);
    EXPECT_EQ(engine.stateHash(), plain.stateHash());
}

TEST(Capsules, OutOfReachTheyCostNothing) {
    const Strands strands = levelStrands(8);
    Engine engine = makeEngine(strands, onBar(StrandModel::rods));
    const std::vector<Sphere> far{{{5, 0, 0}, 0.1f}, {{6, 0, 0}, 0.1f}},
        around{{{-5, 0, 0}, 0.1f}, {{5, 0, 0}, 0.1f}};
    step(engine, strands, 1, far, kOne);
    EXPECT_FALSE(engine.plan().on(Effect::collision));
    EXPECT_EQ(engine.effectBytes(Effect::collision), 0u);
    // Neither end can reach the hair, what lies between them can.
    step(engine, strands, 2, around, kOne);
    EXPECT_TRUE(engine.plan().on(Effect::collision));
}

}  // namespace
}  // namespace hairloom::runtime
