// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

constexpr double kStretch = 0.01;

void expectSound(const Engine& engine, const char* what) {
    const Measurements m = engine.measure();
    EXPECT_EQ(m.nanCount, 0u) << what;
    EXPECT_LT(m.maxStretch, kStretch) << what;
    EXPECT_TRUE(std::isfinite(m.kineticEnergy)) << what;
}

TEST(HardCases, AHeadTurningAtTenTurnsASecondKeepsItsHairsLength) {
    for (const std::uint32_t clamped : {1u, 2u}) {
        const Strands strands = tuft(30);
        SimulationSettings s = springSettings();
        s.clampedPoints = clamped;
        Engine engine = makeEngine(strands, s);
        for (int f = 1; f <= 300; ++f) {
            const float angle = 20.0f * std::numbers::pi_v<float> * static_cast<float>(f) / 60.0f;
            const auto roots = strands.roots({}, turnAbout({0.0f, 1.0f, 0.0f}, angle));
            engine.step({1.0f / 60.0f, f / 60.0, roots, {}});
            expectSound(engine, "spin");
        }
        // Nothing moves faster than the tip of a straight strand on the turning head.
        std::vector<Float3> v(engine.pointCount());
        engine.readVelocities(v);
        for (const Float3& p : v) EXPECT_LT(length(p), 62.8f * 0.35f);
    }
}

TEST(HardCases, PointsLeftFarBehindComeBackToTheirLength) {
    // The root goes 5 km in one substep: what is left of segments of 11 mm after single precision has been
    // there is 0.2 mm.
    const Strands strands = tuft(30);
    SimulationSettings s = bare();
    s.substeps = 1;
    s.teleportDistance = 1e4f;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 2);
    engine.step({1.0f / 60.0f, 0.1, strands.roots({5000.0f, 0.0f, 0.0f}), {}});
    EXPECT_LT(engine.measure().maxStretch, 1.01f * s.maximalExtension);
}

TEST(HardCases, EnergyDoesNotGrow) {
    // Undamped, without gravity or air: a swinging chain may lose energy, never gain it.
    const Strands strands = tuft(10);
    SimulationSettings s = bare();
    s.gravity = {3.0f, -9.81f, 2.0f};
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 20);
    s.gravity = {};
    ASSERT_EQ(engine.setSettings(s), "");
    run(engine, strands, 1);
    const double start = engine.measure().kineticEnergy;
    double maximum = 0.0;
    for (int f = 0; f < 600; ++f) {
        run(engine, strands, 1);
        maximum = std::max(maximum, engine.measure().kineticEnergy);
    }
    EXPECT_LT(maximum, 1.02 * start);
    expectSound(engine, "free swing");
}

TEST(HardCases, TeleportOfTenMetresCarriesTheHair) {
    const Strands strands = tuft(20);
    Engine engine = makeEngine(strands, {});
    run(engine, strands, 60);
    const std::vector<Float3> before = positionsOf(engine);
    const auto roots = strands.roots({10.0f, 0.0f, 0.0f});
    Engine notTeleported = engine;
    run(notTeleported, strands, 1);
    engine.step({1.0f / 60.0f, 0.0, roots, {}});
    expectSound(engine, "cut");
    EXPECT_NEAR(engine.measure().kineticEnergy, notTeleported.measure().kineticEnergy, 1e-3);
    const std::vector<Float3> after = positionsOf(engine);
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_LT(length(after[i] - before[i] - Float3{10.0f, 0.0f, 0.0f}), 0.02f);
    }
    // The same way taken as motion is violent but stays sound.
    SimulationSettings s;
    s.teleportDistance = 100.0f;
    Engine torn = makeEngine(strands, s);
    torn.step({1.0f / 60.0f, 0.0, roots, {}});
    expectSound(torn, "torn away");
    for (int f = 0; f < 120; ++f) torn.step({1.0f / 60.0f, 0.0, roots, {}});
    expectSound(torn, "after being torn away");
    EXPECT_LT(torn.measure().kineticEnergy, 5.0);
}

TEST(HardCases, AnyFrameTime) {
    const Strands strands = tuft(20, true);
    SimulationSettings s = springSettings();
    s.windSpeed = 10.0f;
    Engine engine = makeEngine(strands, s);
    const auto roots = strands.roots();
    const std::vector<Sphere> spheres{{{0.05f, 0.0f, 0.0f}, 0.05f}};
    const float times[] = {0.001f, 0.1f, 1.0f / 30.0f, 1.0f, 0.25f, 1e-6f, 0.1f};
    for (int f = 0; f < 700; ++f) {
        engine.step({times[f % 7], 0.1 * f, roots, spheres});
        expectSound(engine, "frame times");
    }
    const std::uint64_t hash = engine.stateHash();
    for (const float dt : {0.0f, -1.0f, std::nanf(""), INFINITY}) engine.step({dt, 0.0, roots, {}});
    EXPECT_EQ(engine.stateHash(), hash);
}

TEST(HardCases, SegmentsWithoutLengthFoldsAndCoincidentPoints) {
    Strands strands;
    strands.points = {
        {0, 0, 0}, {0, 0, 0},        {0, -0.02f, 0},   {0, -0.02f, 0},   {0, -0.04f, 0},  // doubled
        {0, 0, 0}, {0, -0.02f, 0},   {0, 0, 0},        {0, -0.02f, 0},   {0, 0, 0},       // folded to and fro
        {0, 0, 0}, {0, -0.0001f, 0}, {0, -0.0002f, 0}, {0, -0.0003f, 0}, {0, -0.0004f, 0}};
    strands.offsets = {0, 5, 10, 15};
    for (const float stiffness : {0.0f, 0.3f, 1.0f}) {
        SimulationSettings s = springSettings();
        s.angularStiffness = stiffness;
        s.windSpeed = 5.0f;
        Engine engine = makeEngine(strands, s);
        run(engine, strands, 200);
        expectSound(engine, "degenerate");
    }
}

TEST(HardCases, ReversedSegmentRecovers) {
    // Rest points up; the root turns by exactly 180° in one frame.
    Strands strands;
    strands.add({}, {0.0f, 1.0f, 0.0f}, 0.02f, 8);
    SimulationSettings s = bare();
    s.angularStiffness = 0.5f;
    s.dampingTime = 0.1f;
    Engine engine = makeEngine(strands, s);
    const Quat half{1.0f, 0.0f, 0.0f, 0.0f};
    for (int f = 0; f < 400; ++f) {
        engine.step({1.0f / 60.0f, 0.0, strands.roots({}, half), {}});
        expectSound(engine, "half turn");
    }
    EXPECT_NEAR(positionsOf(engine)[7].y, -0.14f, 1e-3f);
}

TEST(HardCases, SpheresThatSwallowRootsOverlapOrCrossTheHair) {
    const Strands strands = tuft(30);
    Engine engine = makeEngine(strands, {});
    const auto roots = strands.roots();
    for (int f = 0; f < 300; ++f) {
        const float x = 0.3f * std::sin(0.5f * static_cast<float>(f));
        const std::vector<Sphere> spheres{{{0.05f, 0.1f, 0.0f}, 0.08f},
                                          {{x, 0.05f, 0.0f}, 0.05f},
                                          {{x + 0.03f, 0.05f, 0.0f}, 0.05f},
                                          {{0.1f, 0.1f, x}, 0.5f}};
        engine.step({1.0f / 60.0f, 0.0, roots, spheres});
        expectSound(engine, "spheres");
    }
    run(engine, strands, 300);
    EXPECT_LT(engine.measure().kineticEnergy, 0.05);
}

TEST(HardCases, WindOfAHundredMetresPerSecondThatReverses) {
    const Strands strands = tuft(30);
    SimulationSettings s = springSettings();
    s.windSpeed = 100.0f;
    s.airDrag = 1000.0f;
    Engine engine = makeEngine(strands, s);
    for (int f = 0; f < 300; ++f) {
        s.windDirection.x = f % 2 == 0 ? 1.0f : -1.0f;
        ASSERT_EQ(engine.setSettings(s), "");
        run(engine, strands, 1);
        expectSound(engine, "reversing wind");
    }
}

TEST(HardCases, NonFiniteRootsKeepTheirPose) {
    const Strands strands = tuft(3);
    Engine engine = makeEngine(strands, {});
    auto roots = strands.roots();
    roots[1].position.x = std::nanf("");
    roots[2].rotation = {0.0f, 0.0f, 0.0f, 0.0f};
    engine.step({1.0f / 60.0f, std::nan(""), roots, {}});
    EXPECT_EQ(engine.lastStep().rejectedRoots, 2u);
    expectSound(engine, "bad roots");
    EXPECT_EQ(positionsOf(engine)[12], strands.points[12]);
}

TEST(HardCases, InvalidStrandsAreRefused) {
    Strands strands = tuft(2);
    const auto errorOf = [](const Strands& bad) { return Engine::make(bad.view(), {}).error; };
    Strands one = strands;
    one.offsets = {0, 1, 24};
    EXPECT_EQ(errorOf(one), "strand 0 runs from point 0 to 1; expected 2 to 512 points");
    Strands descending = strands;
    descending.offsets = {0, 4000000000u, 24};
    EXPECT_NE(errorOf(descending), "");
    Strands beyond = strands;
    beyond.offsets = {0, 12, 25};
    EXPECT_EQ(errorOf(beyond), "strand offsets run from 0 to 25; expected 0 to the number of points, 24");
    Strands nan = strands;
    nan.points[5].z = std::nanf("");
    EXPECT_EQ(errorOf(nan), "rest position of point 5 is not a number within 1e6 m");
    SimulationSettings s = springSettings();
    s.substeps = 0;
    EXPECT_EQ(Engine::make(strands.view(), s).error, "substeps is 0; expected 1 to 256");
}

}  // namespace
}  // namespace hairloom::runtime
