// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

TEST(Collision, PointsEndOnASphereAwayFromTheOrigin) {
    Strands strands;
    strands.add({3.0f, 2.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, 0.02f, 12);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.dampingTime = 0.3f;
    s.pearlRadiusRoot = 0.001f;
    s.pearlRadiusTip = 0.003f;
    const std::vector<Sphere> spheres{{{3.1f, 1.88f, 1.003f}, 0.1f}};
    Engine engine = makeEngine(strands, s);
    for (int f = 0; f < 240; ++f) {
        run(engine, strands, 1, 1.0f / 60.0f, spheres);
        ASSERT_LT(engine.measure().maxPenetration, 5e-4) << f;
    }
    EXPECT_TRUE(engine.plan().on(Effect::collision));
    EXPECT_LT(engine.measure().maxStretch, 0.0051);
    // Eq. 21 as printed would put the points around the origin, metres away.
    for (const Float3& p : positionsOf(engine)) EXPECT_LT(length(p - strands.points[0]), 0.23f);
}

TEST(Collision, APointAtTheCentreLeavesUpwardsByTheRadiusAndItsPearl) {
    Strands strands;
    strands.add({0.5f, 0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}, 0.2f, 2);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    s.substeps = 1;
    s.pearlRadiusTip = 0.01f;
    const std::vector<Sphere> spheres{{strands.points[1], 0.05f}};
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 1, 0.01f, spheres);
    const Float3 moved = positionsOf(engine)[1] - strands.points[1];
    EXPECT_NEAR(moved.y, 0.06f, 1e-6f);
    EXPECT_NEAR(moved.x, 0.0f, 1e-6f);
    EXPECT_NEAR(moved.z, 0.0f, 1e-6f);
}

/// One free point that flies at (2, −3, 0) m/s into the very top of a sphere; its velocity after the impact.
Float3 velocityAfterImpact(float friction, float restitution, Float3 sphereVelocity = {}) {
    Strands strands;
    strands.add({0.0f, 0.1f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.1f, 2);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    s.substeps = 1;
    s.pearlRadiusTip = 0.0f;
    s.friction = friction;
    s.restitution = restitution;
    const float dt = 1e-3f;
    s.gravity = {500.0f, -750.0f, 0.0f};
    Engine engine = makeEngine(strands, s);
    const std::vector<RootFrame> roots = strands.roots();
    for (int f = 0; f < 4; ++f) engine.step({dt, 0.0, roots, {}});
    s.gravity = {};
    EXPECT_EQ(engine.setSettings(s), "");
    // Where the point will be, the sphere will reach 0.2 mm higher; a small sphere below gives it its speed
    // before.
    const Float3 next = positionsOf(engine)[1] + Float3{2.0f, -3.0f, 0.0f} * (2.0f * dt);
    const Float3 centre = next + Float3{0.0f, -0.0998f, 0.0f};
    const std::vector<Sphere> before{{centre - sphereVelocity * dt, 0.01f}};
    const std::vector<Sphere> after{{centre, 0.1f}};
    engine.step({dt, 0.0, roots, before});
    engine.step({dt, 0.0, roots, after});
    EXPECT_NEAR(length(positionsOf(engine)[1] - centre), 0.1f, 1e-6f);
    std::vector<Float3> v(2);
    engine.readVelocities(v);
    return v[1];
}

void expectNear(Float3 v, Float3 expected) {
    EXPECT_NEAR(v.x, expected.x, 2e-3f);
    EXPECT_NEAR(v.y, expected.y, 2e-3f);
    EXPECT_NEAR(v.z, expected.z, 2e-3f);
}

TEST(Collision, RestitutionIsThatOfEquation20) {
    expectNear(velocityAfterImpact(0.0f, 0.0f), {2.0f, 0.0f, 0.0f});
    expectNear(velocityAfterImpact(0.0f, 0.5f), {2.0f, 1.5f, 0.0f});
    expectNear(velocityAfterImpact(0.0f, 1.0f), {2.0f, 3.0f, 0.0f});
    // With a sphere that rises at 1 m/s the approach is 4 m/s.
    expectNear(velocityAfterImpact(0.0f, 0.5f, {0.0f, 1.0f, 0.0f}), {2.0f, 3.0f, 0.0f});
}

TEST(Collision, FrictionIsCoulombs) {
    expectNear(velocityAfterImpact(0.2f, 0.0f), {2.0f - 0.2f * 3.0f, 0.0f, 0.0f});
    expectNear(velocityAfterImpact(1.0f, 0.0f), {0.0f, 0.0f, 0.0f});
    // A sphere that moves along takes a sticking point with it.
    expectNear(velocityAfterImpact(1.0f, 0.0f, {1.0f, 0.0f, 0.0f}), {1.0f, 0.0f, 0.0f});
}

TEST(Collision, SpheresWithoutSizeOrPlaceAreLeftOut) {
    const Strands strands = tuft(4);
    SimulationSettings s;
    Engine with = makeEngine(strands, s), without = makeEngine(strands, s);
    const float nan = std::nanf("");
    const std::vector<Sphere> bad{
        {{0, 0, 0}, 0.0f}, {{0, 0, 0}, -0.2f}, {{nan, 0, 0}, 0.2f}, {{0, 0, 0}, nan}};
    run(with, strands, 10, 1.0f / 60.0f, bad);
    run(without, strands, 10);
    EXPECT_EQ(with.lastStep().rejectedSpheres, 4u);
    EXPECT_EQ(with.stateHash(), without.stateHash());
}

}  // namespace
}  // namespace hairloom::runtime
