// SPDX-License-Identifier: GPL-3.0-or-later
// Penalty springs out of spheres.
#include <numbers>

#include "tests/runtime/free_points.h"

namespace hairloom::runtime {
namespace {

TEST(PenaltyForce, IsASpringOfItsFrequency) {
    FreePoints points;
    points.add({0.0f, 0.0f, 0.0f});
    points.settings.collisionResponse = CollisionResponse::penalty;
    points.settings.penaltyFrequency = 20.0f;
    Engine engine = points.engine();
    const std::vector<Sphere> sphere{{{0.0f, -0.09f, 0.0f}, 0.1f}};
    // From rest 1 cm deep it is on the surface after a quarter of a period, at the speed ω · 1 cm.
    const float h = 1e-4f;
    run(engine, points.strands, 125, h, sphere);
    EXPECT_NEAR(FreePoints::position(engine).y, 0.01f, 1e-4f);
    run(engine, points.strands, 25, h, sphere);
    EXPECT_NEAR(FreePoints::velocity(engine).y, 2.0f * std::numbers::pi_v<float> * 20.0f * 0.01f, 0.005f);
}

TEST(PenaltyForce, OfACentreActsUpwards) {
    FreePoints points;
    points.add({0.0f, 0.0f, 0.0f});
    points.settings.collisionResponse = CollisionResponse::penalty;
    Engine engine = points.engine();
    run(engine, points.strands, 1, 1e-4f, std::vector<Sphere>{{FreePoints::position(engine), 0.1f}});
    const float omega = 2.0f * std::numbers::pi_v<float> * 100.0f;
    const Float3 moved = FreePoints::position(engine);
    // From rest: ½ a h².
    EXPECT_NEAR(moved.y, 0.5f * omega * omega * 0.1f * 1e-8f, 1e-6f);
    EXPECT_NEAR(moved.x, 0.0f, 1e-9f);
}

TEST(PenaltyForce, LeavesPointsJustOutsideAlone) {
    const std::vector<Sphere> sphere{{{0.0f, 0.0f, 0.0f}, 0.08f}};
    FreePoints points;
    points.settings.collisionResponse = CollisionResponse::penalty;
    // Every other one pulls the rest of its vector into the computation.
    for (int k = 0; k < 400; ++k) {
        const float angle = 0.37f * static_cast<float>(k), height = std::cos(0.11f * static_cast<float>(k));
        const float across = std::sqrt(1.0f - height * height);
        const float distance = 0.08f * (k % 2 == 0 ? 0.99f : 1.0f + 1.5e-7f * static_cast<float>(k % 5));
        points.add(Float3{across * std::cos(angle), height, across * std::sin(angle)} * distance);
    }
    Engine engine = points.engine();
    run(engine, points.strands, 1, 1.0f / 600.0f, sphere);
    std::size_t outside = 0;
    for (std::size_t k = 0; k < points.strands.count(); ++k) {
        const Float3 before = points.strands.points[2 * k + 1];
        if (length(before) < 0.08f * (1.0f + 1.2e-7f)) continue;
        ++outside;
        EXPECT_EQ(FreePoints::position(engine, k), before) << k;
    }
    EXPECT_GT(outside, 100u);
}

}  // namespace
}  // namespace hairloom::runtime
