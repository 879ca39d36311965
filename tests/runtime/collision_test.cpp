// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <random>

#include "tests/runtime/free_points.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/support/spring_settings.h"

namespace hairloom::runtime {
namespace {

TEST(Collision, PointsEndOnASphereAwayFromTheOrigin) {
    Strands strands;
    strands.add({3.0f, 2.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, 0.02f, 12);
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.dampingTime = 0.3f;
    s.collisionRadiusRoot = 0.001f;
    s.collisionRadiusTip = 0.003f;
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

TEST(Collision, PointAtTheCentreLeavesUpwardsByBothRadii) {
    Strands strands;
    strands.add({0.5f, 0.5f, 0.5f}, {1.0f, 0.0f, 0.0f}, 0.2f, 2);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    s.substeps = 1;
    s.collisionRadiusTip = 0.01f;
    const std::vector<Sphere> spheres{{strands.points[1], 0.05f}};
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 1, 0.01f, spheres);
    const Float3 moved = positionsOf(engine)[1] - strands.points[1];
    EXPECT_NEAR(moved.y, 0.06f, 1e-6f);
    EXPECT_NEAR(moved.x, 0.0f, 1e-6f);
    EXPECT_NEAR(moved.z, 0.0f, 1e-6f);
}

/// Along the strand its length would hold the points back; the one at the centre, the ones beside it and the
/// strand as a whole go sideways.
TEST(Collision, AStrandStraightThroughACentreLeavesSideways) {
    Strands strands;
    strands.add({0.0f, 0.3f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.012f, 16);
    SimulationSettings s = springSettings();
    const std::vector<Sphere> spheres{{strands.points[8], 0.02f}};
    for (const CollisionResponse response : {CollisionResponse::radial, CollisionResponse::backward}) {
        s.collisionResponse = response;
        Engine engine = makeEngine(strands, s);
        run(engine, strands, 30, 1.0f / 60.0f, spheres);
        for (int f = 0; f < 60; ++f) {
            run(engine, strands, 1, 1.0f / 60.0f, spheres);
            ASSERT_LT(engine.measure().maxPenetration, 5e-4) << f;
        }
        EXPECT_LT(engine.measure().maxStretch, 0.0051);
    }
}

/// One free point that flies at (2, −3, 0) m/s into the very top of a sphere; its velocity after the impact.
Float3 velocityAfterImpact(float friction, float restitution, Float3 sphereVelocity = {}) {
    Strands strands;
    strands.add({0.0f, 0.1f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.1f, 2);
    SimulationSettings s = bare();
    s.lengthIterations = 0;
    s.substeps = 1;
    s.collisionRadiusTip = 0.0f;
    s.friction = friction;
    s.restitution = restitution;
    const float dt = 1e-3f;
    // From rest the first step gives half of g h.
    s.gravity = {500.0f, -750.0f, 0.0f};
    s.gravity = s.gravity * (4.0f / 3.5f);
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

TEST(Collision, InvalidSpheresAreIgnored) {
    const Strands strands = tuft(4);
    SimulationSettings s = springSettings();
    Engine with = makeEngine(strands, s), without = makeEngine(strands, s);
    const float nan = std::nanf("");
    const std::vector<Sphere> bad{
        {{0, 0, 0}, 0.0f}, {{0, 0, 0}, -0.2f}, {{nan, 0, 0}, 0.2f}, {{0, 0, 0}, nan}};
    run(with, strands, 10, 1.0f / 60.0f, bad);
    run(without, strands, 10);
    EXPECT_EQ(with.lastStep().rejectedSpheres, 4u);
    EXPECT_EQ(with.stateHash(), without.stateHash());
}

struct Double3 {
    double x, y, z;
};
double gap(Double3 a, Float3 b) {
    return std::hypot(a.x - static_cast<double>(b.x), a.y - static_cast<double>(b.y),
                      a.z - static_cast<double>(b.z));
}
double penetration(Float3 at, std::span<const Sphere> spheres) {
    double maximum = 0.0;
    for (const Sphere& s : spheres) {
        maximum = std::max(maximum, static_cast<double>(s.radius) - gap({at.x, at.y, at.z}, s.center_ws));
    }
    return maximum;
}

/// Where a point that moves by `displacement` to `end` first meets the sphere.
Float3 entrance(Float3 end, Float3 displacement, const Sphere& sphere) {
    const Float3 offset = end - sphere.center_ws;
    const double a = dot(displacement, displacement), b = dot(displacement, offset);
    const double c = static_cast<double>(dot(offset, offset)) -
                     static_cast<double>(sphere.radius) * static_cast<double>(sphere.radius);
    return end + displacement * static_cast<float>((-b - std::sqrt(b * b - a * c)) / a);
}

TEST(Collision, AThrownPointComesBackToTheSquareOfItsRestitution) {
    FreePoints points;
    points.add({0.0f, 0.1f, 0.0f});
    points.settings.restitution = 0.6f;
    points.settings.gravity = {0.0f, -9.81f, 0.0f};
    Engine engine = points.engine();
    const std::vector<Sphere> ground{{{0.0f, -1.0f, 0.0f}, 1.0f}};
    const float h = 1e-4f;
    const float fall = std::sqrt(2.0f * 0.1f / 9.81f);
    run(engine, points.strands, static_cast<int>(fall / h) + 20, h, ground);
    float apex = 0.0f;
    for (int f = 0; f < static_cast<int>(1.3f * fall / h); ++f) {
        run(engine, points.strands, 1, h, ground);
        apex = std::max(apex, FreePoints::position(engine).y);
    }
    EXPECT_NEAR(apex, 0.36f * 0.1f, 0.36f * 0.1f * 0.02f);
}

TEST(Collision, APointStaysWhereTheSlopeIsBelowTheFrictionAndSlidesAbove) {
    const auto slid = [](float degrees) {
        FreePoints points;
        const float angle = degrees * std::numbers::pi_v<float> / 180.0f;
        points.add({0.1f * std::sin(angle), 0.1f * std::cos(angle), 0.0f});
        points.settings.friction = 0.5f;
        points.settings.gravity = {0.0f, -9.81f, 0.0f};
        Engine engine = points.engine();
        const Float3 from = FreePoints::position(engine);
        run(engine, points.strands, 200, 5e-4f, std::vector<Sphere>{{{0.0f, 0.0f, 0.0f}, 0.1f}});
        return static_cast<double>(length(FreePoints::position(engine) - from));
    };
    const double critical = std::atan(0.5) * 180.0 / std::numbers::pi;  // 26.6°
    EXPECT_LT(slid(static_cast<float>(critical) - 0.5f), 1e-5);
    EXPECT_GT(slid(static_cast<float>(critical) + 0.5f), 2e-4);
    // r φ'' = g sin φ − µ (g cos φ − r φ'²), after 0.1 s.
    const double start = 35.0 * std::numbers::pi / 180.0, g = 9.81, r = 0.1;
    double phi = start, speed = 0.0;
    for (int n = 0; n < 100000; ++n) {
        speed += 1e-6 * (g * std::sin(phi) - 0.5 * (g * std::cos(phi) - r * speed * speed)) / r;
        phi += 1e-6 * speed;
    }
    const double expected = 2.0 * r * std::sin((phi - start) / 2.0);
    EXPECT_NEAR(slid(35.0f), expected, 0.02 * expected);
}

TEST(Collision, APointOfAHundredMetresPerSecondIsCaughtWhereItEnters) {
    for (const CollisionResponse response : {CollisionResponse::radial, CollisionResponse::backward}) {
        FreePoints points;
        points.add({0.0f, 0.0f, 0.0f});
        points.settings.collisionResponse = response;
        Engine engine = points.engine();
        const float dt = 2e-3f;
        points.accelerate(engine, {0.0f, -0.2f, 0.0f}, dt);
        const Float3 displacement = FreePoints::velocity(engine) * dt;
        EXPECT_NEAR(FreePoints::velocity(engine).y, -100.0f, 0.01f);
        const Float3 end = FreePoints::position(engine) + displacement;
        // The point passes both spheres; the other one stands later on its way.
        const Sphere first{end - displacement * 0.5f + Float3{0.02f, 0.0f, 0.01f}, 0.05f};
        const Sphere second{end + Float3{0.0f, 0.03f, 0.0f}, 0.02f};
        run(engine, points.strands, 1, dt, std::vector<Sphere>{second, first});
        const Float3 expected = entrance(end, displacement, first);
        EXPECT_LT(length(FreePoints::position(engine) - expected), 1e-5f);
        const Float3 normal = (expected - first.center_ws) * (1.0f / first.radius);
        const Float3 before{0.0f, -100.0f, 0.0f};
        const Float3 after = before - normal * dot(before, normal);
        EXPECT_LT(length(FreePoints::velocity(engine) - after), 0.02f);
    }
}

TEST(Collision, ASphereOfAHundredMetresPerSecondTakesThePointAlong) {
    FreePoints points;
    points.add({0.0f, 0.0f, 0.0f});
    Engine engine = points.engine();
    const float dt = 2e-3f;
    run(engine, points.strands, 1, dt, std::vector<Sphere>{{{-0.1f, 0.0f, 0.0f}, 0.05f}});
    run(engine, points.strands, 1, dt, std::vector<Sphere>{{{0.1f, 0.0f, 0.0f}, 0.05f}});
    EXPECT_LT(length(FreePoints::position(engine) - Float3{0.15f, 0.0f, 0.0f}), 1e-5f);
    EXPECT_NEAR(FreePoints::velocity(engine).x, 100.0f, 0.02f);
}

TEST(Collision, BackwardResponseReturnsToTheEntryPoint) {
    const float dt = 2e-3f;
    const Float3 displacement{0.006f, -0.012f, 0.003f};
    const auto placed = [&](CollisionResponse response, Float3& end, Sphere& sphere) {
        FreePoints points;
        points.add({0.0f, 0.0f, 0.0f});
        points.settings.collisionResponse = response;
        Engine engine = points.engine();
        points.accelerate(engine, displacement, dt);
        end = FreePoints::position(engine) + displacement;
        sphere = {end + Float3{0.02f, -0.085f, 0.01f}, 0.09f};
        run(engine, points.strands, 1, dt, std::vector<Sphere>{sphere});
        return FreePoints::position(engine);
    };
    Float3 end;
    Sphere sphere;
    const Float3 backward = placed(CollisionResponse::backward, end, sphere);
    EXPECT_LT(length(backward - entrance(end, displacement, sphere)), 2e-6f);
    const Float3 radial = placed(CollisionResponse::radial, end, sphere);
    const Float3 offset = end - sphere.center_ws;
    EXPECT_LT(length(radial - (sphere.center_ws + offset * (sphere.radius / length(offset)))), 2e-6f);
    EXPECT_GT(length(radial - backward), 1e-4f);
}

TEST(Collision, BackwardWithoutEntryPointIsRadial) {
    FreePoints points;
    points.add({0.0f, 0.0f, 0.0f});
    points.settings.collisionResponse = CollisionResponse::backward;
    Engine engine = points.engine();
    run(engine, points.strands, 1, 2e-3f, std::vector<Sphere>{{{-0.04f, -0.03f, 0.0f}, 0.1f}});
    EXPECT_LT(length(FreePoints::position(engine) - Float3{0.04f, 0.03f, 0.0f}), 1e-6f);
}

TEST(Collision, CollisionRadiusGrowsLinearlyToTheTip) {
    Strands strands;
    strands.add({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.02f, 6);
    SimulationSettings s = FreePoints().settings;
    s.collisionRadiusRoot = 0.002f;
    s.collisionRadiusTip = 0.012f;
    const std::vector<Sphere> sphere{{{0.05f, -0.02f, 0.0f}, 0.3f}};
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 1, 1e-3f, sphere);
    const std::vector<Float3> points = positionsOf(engine);
    for (std::size_t p = 1; p < 6; ++p) {
        EXPECT_NEAR(length(points[p] - sphere[0].center_ws), 0.302f + 0.002f * static_cast<float>(p), 1e-6f)
            << p;
    }
}

TEST(Collision, PointsBetweenOverlappingSpheresEndInTheFree) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    const auto direction = [&] {
        const Float3 v{normal(random), normal(random), normal(random)};
        return v * (1.0f / length(v));
    };
    for (const std::size_t count : {2u, 5u}) {
        std::size_t tested = 0;
        double worst = 0.0, worstLater = 0.0;
        while (tested < 1500) {
            std::vector<Sphere> spheres;
            for (std::size_t k = 0; k < count; ++k) {
                spheres.push_back({Float3{normal(random), normal(random), normal(random)} * 0.05f,
                                   0.04f + 0.06f * uniform(random)});
            }
            FreePoints points;
            for (int k = 0; k < 400; ++k) {
                const Sphere& sphere = spheres[random() % count];
                const Float3 at = sphere.center_ws + direction() * (sphere.radius - 0.01f * uniform(random));
                const auto inside = std::count_if(spheres.begin(), spheres.end(), [&](const Sphere& s) {
                    return length(at - s.center_ws) < s.radius;
                });
                bool freeNearby = false;
                for (int n = 0; n < 100 && !freeNearby && inside > 1; ++n) {
                    freeNearby =
                        penetration(at + direction() * (0.01f * std::cbrt(uniform(random))), spheres) == 0.0;
                }
                if (freeNearby) points.add(at);
            }
            if (points.strands.count() == 0) continue;
            Engine engine = points.engine();
            run(engine, points.strands, 1, 2e-3f, spheres);
            const std::vector<Float3> first = positionsOf(engine);
            run(engine, points.strands, 3, 2e-3f, spheres);
            const std::vector<Float3> later = positionsOf(engine);
            for (std::size_t p = 1; p < first.size(); p += 2) {
                worst = std::max(worst, penetration(first[p], spheres));
                worstLater = std::max(worstLater, static_cast<double>(length(later[p] - first[p])));
            }
            tested += points.strands.count();
        }
        RecordProperty("penetration_um_" + std::to_string(count), static_cast<int>(worst * 1e6));
        EXPECT_LT(worst, 5e-4) << count;
        // What has been settled stays where it is.
        EXPECT_LT(worstLater, 1e-3) << count;
    }
}

TEST(Collision, HairBetweenOverlappingSpheresComesToRest) {
    Strands strands;
    for (int k = 0; k < 8; ++k) {
        strands.add({0.02f * static_cast<float>(k) - 0.07f, 0.12f, 0.01f}, {0.0f, 0.0f, 1.0f}, 0.012f, 16);
    }
    SimulationSettings s = bare();
    s.gravity = {0.0f, -9.81f, 0.0f};
    s.dampingTime = 0.2f;
    std::vector<Sphere> spheres;
    for (int k = 0; k < 5; ++k)
        spheres.push_back(
            {{0.05f * static_cast<float>(k) - 0.1f, 0.02f * static_cast<float>(k % 2), 0.08f}, 0.07f});
    Engine engine = makeEngine(strands, s);
    run(engine, strands, 300, 1.0f / 60.0f, spheres);
    const std::vector<Float3> before = positionsOf(engine);
    run(engine, strands, 60, 1.0f / 60.0f, spheres);
    const std::vector<Float3> after = positionsOf(engine);
    for (std::size_t p = 0; p < after.size(); ++p) EXPECT_LT(length(after[p] - before[p]), 5e-4f) << p;
    EXPECT_LT(engine.measure().maxPenetration, 5e-4);
}

TEST(Collision, ASphereThatShrinksAndVanishesLeavesHairAlone) {
    FreePoints points;
    points.add({0.0f, 0.0f, 0.0f});
    Engine engine = points.engine();
    // It appears around the point: out, but with no speed of its own.
    run(engine, points.strands, 1, 2e-3f, std::vector<Sphere>{{{0.0f, -0.05f, 0.0f}, 0.08f}});
    EXPECT_LT(length(FreePoints::position(engine) - Float3{0.0f, 0.03f, 0.0f}), 1e-6f);
    EXPECT_LT(length(FreePoints::velocity(engine)), 1e-3f);
    for (float radius = 0.08f; radius > -0.03f; radius -= 0.01f) {
        run(engine, points.strands, 1, 2e-3f, std::vector<Sphere>{{{0.0f, -0.05f, 0.0f}, radius}});
        EXPECT_EQ(engine.lastStep().rejectedSpheres, radius > 0.0f ? 0u : 1u);
    }
    EXPECT_LT(length(FreePoints::position(engine) - Float3{0.0f, 0.03f, 0.0f}), 1e-6f);
}

/// Hair and spheres that move through it, slowly and fast; the strands all in one engine or each in its own.
std::vector<Float3> swept(const Strands& strands, CollisionResponse response) {
    SimulationSettings s = springSettings();
    s.collisionResponse = response;
    s.restitution = 0.2f;
    s.teleportDistance = 10.0f;
    s.sleepSpeed = 0.0f;  // strands fall asleep by blocks
    Engine engine = makeEngine(strands, s);
    const std::vector<RootFrame> roots = strands.roots();
    for (int f = 0; f < 40; ++f) {
        const float t = static_cast<float>(f) / 60.0f;
        std::vector<Sphere> spheres{{{0.1f, 0.02f, 0.0f}, 0.05f},
                                    {{0.12f, 0.03f, 0.03f * std::sin(9.0f * t)}, 0.06f},
                                    {{0.05f, 0.05f * std::sin(5.0f * t), 0.02f}, 0.055f},
                                    {{0.1f + 3.0f * std::sin(40.0f * t), 0.1f, 0.0f}, 0.04f}};
        engine.step({1.0f / 60.0f, t, roots, spheres});
    }
    EXPECT_EQ(engine.measure().nanCount, 0u);
    return positionsOf(engine);
}

TEST(Collision, StrandsCollideIndependently) {
    for (const CollisionResponse response :
         {CollisionResponse::radial, CollisionResponse::backward, CollisionResponse::penalty}) {
        const Strands together = tuft(45);
        const std::vector<Float3> all = swept(together, response);
        for (std::uint32_t s = 0; s < together.count(); ++s) {
            Strands alone;
            alone.points.assign(together.points.begin() + together.offsets[s],
                                together.points.begin() + together.offsets[s + 1]);
            alone.offsets.push_back(static_cast<std::uint32_t>(alone.points.size()));
            const std::vector<Float3> one = swept(alone, response);
            for (std::size_t p = 0; p < one.size(); ++p)
                ASSERT_EQ(one[p], all[together.offsets[s] + p]) << s << ' ' << p;
        }
    }
}

TEST(Collision, HandlesManySpheres) {
    FreePoints points;
    std::vector<Sphere> spheres;
    for (int k = 0; k < 200; ++k) {
        const float x = 0.5f * static_cast<float>(k);
        points.add({x + 0.05f, 0.0f, 0.0f});
        spheres.push_back({{x, 0.0f, 0.0f}, 0.1f});
    }
    Engine engine = points.engine();
    run(engine, points.strands, 1, 1e-3f, spheres);
    for (std::size_t k = 0; k < 200; ++k)
        EXPECT_NEAR(length(FreePoints::position(engine, k) - spheres[k].center_ws), 0.1f, 5e-6f) << k;
}

TEST(Collision, SpheresOfDifferentSetsHaveCommonEdges) {
    // Each sphere overlaps one that is 70 numbers behind it: points between the two lie in both.
    FreePoints points;
    std::vector<Sphere> spheres;
    constexpr int kPairs = 70;
    for (const float side : {-0.09f, 0.09f}) {
        for (int k = 0; k < kPairs; ++k)
            spheres.push_back({{side + 0.5f * static_cast<float>(k), 0.0f, 0.0f}, 0.1f});
    }
    for (int k = 0; k < kPairs; ++k) {
        const float x = 0.5f * static_cast<float>(k);
        for (const float side : {-0.004f, 0.0f, 0.004f}) points.add({x + side, 0.03f, 0.005f});
    }
    Engine engine = points.engine();
    run(engine, points.strands, 1, 1e-3f, spheres);
    for (std::size_t n = 0; n < 3 * kPairs; ++n) {
        const Float3 at = FreePoints::position(engine, n);
        EXPECT_LT(penetration(at, spheres), 1e-5) << n;
        // The circle that both have in common is the nearest way out.
        const Float3 off = at - spheres[n / 3].center_ws - Float3{0.09f, 0.0f, 0.0f};
        EXPECT_NEAR(off.x, 0.0f, 1e-4f) << n;
        EXPECT_NEAR(std::hypot(off.y, off.z), std::sqrt(0.1f * 0.1f - 0.09f * 0.09f), 1e-4f) << n;
    }
}

/// Metres by which a sphere is inside of a segment with its collision radius, sampled along it.
double depthBetweenPoints(std::span<const Float3> points, const SimulationSettings& s, const Sphere& sphere) {
    double deepest = -1e9;
    const auto last = static_cast<double>(points.size() - 1);
    for (std::size_t p = 1; p + 1 < points.size(); ++p) {
        for (int n = 0; n <= 200; ++n) {
            const double t = n / 200.0;
            const auto at = [&](float a, float b, float c) {
                return static_cast<double>(a) + t * (static_cast<double>(b) - static_cast<double>(a)) -
                       static_cast<double>(c);
            };
            const Float3 &a = points[p], &b = points[p + 1], &c = sphere.center_ws;
            const double away = std::hypot(at(a.x, b.x, c.x), at(a.y, b.y, c.y), at(a.z, b.z, c.z));
            const double along = (static_cast<double>(p) + t) / last;
            const double radius = static_cast<double>(s.collisionRadiusRoot) * (1.0 - along) +
                                  static_cast<double>(s.collisionRadiusTip) * along;
            deepest = std::max(deepest, static_cast<double>(sphere.radius) + radius - away);
        }
    }
    return deepest;
}

TEST(SegmentCollision, ASphereBetweenTwoPointsIsSeen) {
    // Segments of 4 cm fall onto a sphere of 1.5 cm.
    Strands strands;
    strands.add({-0.1f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.04f, 9);
    const Sphere sphere{{0.04f, -0.05f, 0.001f}, 0.015f};
    for (const CollisionResponse response : {CollisionResponse::radial, CollisionResponse::backward}) {
        SimulationSettings s = springSettings();
        s.collisionResponse = response;
        s.angularStiffness = 0.02f;
        s.collisionRadiusRoot = s.collisionRadiusTip = 0.001f;
        s.substeps = 16;
        double deepest[2] = {-1e9, -1e9};
        for (const bool segments : {false, true}) {
            s.collisionSegments = segments;
            Engine engine = makeEngine(strands, s);
            for (int f = 0; f < 120; ++f) {
                run(engine, strands, 1, 1.0f / 60.0f, std::span(&sphere, 1));
                deepest[segments ? 1 : 0] =
                    std::max(deepest[segments ? 1 : 0], depthBetweenPoints(positionsOf(engine), s, sphere));
            }
            EXPECT_LT(engine.measure().maxStretch, 0.01);
        }
        EXPECT_GT(deepest[0], 0.003) << "points alone do not see it";
        EXPECT_LT(deepest[1], 0.0012);
    }
}

/// Roots lie in the sphere that stands for the head, and hair is combed over it.
TEST(SegmentCollision, ClampedPointsInsideDoNotThrowTheRest) {
    Strands strands;
    for (int n = 0; n < 40; ++n) {
        const float angle = 0.15f * static_cast<float>(n);
        const Float3 out{std::cos(angle), 0.3f, std::sin(angle)};
        strands.add(out * 0.085f, Float3{-out.z, 0.0f, out.x}, 0.02f, 10);  // along the sphere
    }
    const Sphere sphere{{}, 0.095f};
    for (const std::uint32_t clamped : {1u, 2u}) {
        SimulationSettings s = springSettings();
        s.collisionSegments = true;
        s.clampedPoints = clamped;
        Engine engine = makeEngine(strands, s);
        for (int f = 0; f < 90; ++f) {
            run(engine, strands, 1, 1.0f / 60.0f, std::span(&sphere, 1));
            const std::vector<Float3> now = positionsOf(engine);
            for (std::size_t p = 0; p < now.size(); ++p)
                ASSERT_LT(length(now[p]), 0.085f * 1.1f + 0.19f) << clamped << " frame " << f;
        }
        EXPECT_LT(engine.measure().maxStretch, 0.01) << clamped;
        EXPECT_EQ(engine.measure().nanCount, 0u);
    }
}

TEST(SegmentCollision, AnImpactTakesTheSpeedOfTheSegmentAndRestitutionGivesItBack) {
    // Two free points of a strand without springs or lengths, whose middle flies into a sphere.
    for (const float restitution : {0.0f, 0.6f}) {
        Strands strands;
        strands.add({-0.15f, 0.1f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.1f, 3);
        SimulationSettings s = bare();
        s.lengthIterations = 0;
        s.substeps = 1;
        s.collisionRadiusTip = 0.0f;
        s.friction = 0.0f;
        s.restitution = restitution;
        s.collisionSegments = true;
        s.gravity = {0.0f, -1000.0f, 0.0f};
        Engine engine = makeEngine(strands, s);
        run(engine, strands, 3, 1e-3f);  // away from the sphere, which comes then
        s.gravity = {};
        engine.setSettings(s);
        std::vector<Float3> before(3), after(3);
        engine.readVelocities(before);
        const std::vector<Float3> at = positionsOf(engine);
        const Float3 middle = (at[1] + at[2]) * 0.5f;
        const Sphere sphere{middle - Float3{0.0f, 0.02f - 0.5f * before[1].y * -1e-3f, 0.0f}, 0.02f};
        run(engine, strands, 1, 1e-3f, std::span(&sphere, 1));
        engine.readVelocities(after);
        // Both points are as far from the middle, and share its impulse: Newton's law of restitution.
        const float wanted = -restitution * 0.5f * (before[1].y + before[2].y);
        EXPECT_LT(before[1].y, -1.0f);
        EXPECT_NEAR(0.5f * (after[1].y + after[2].y), wanted, 0.02f);
    }
}

}  // namespace
}  // namespace hairloom::runtime
