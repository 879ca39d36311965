// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres beside the skin collider: those that stand for the skin leave hair to it.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/groom/spheres.h"
#include "core/simulation/sag.h"
#include "core/simulation/scene_input.h"
#include "core/simulation/simulation.h"
#include "hairloom/body_spheres.h"
#include "tests/simulation/hairy_ball.h"

namespace hairloom {
namespace {

using test::hairyBody;
constexpr float kFrame = 1.0f / 60;

Groom ballWith(std::vector<CollisionSphere> spheres) {
    Groom groom = hairyBody();
    groom.spheres = std::move(spheres);
    return groom;
}
CollisionSphere sphereAt(const Vec3f& centre, float radius, std::int32_t joined = -1) {
    return {"s", centre, radius, {}, joined};
}

std::vector<Vec3f> settled(const Groom& groom, const HeadPose& pose = {}) {
    auto simulation = Simulation::make(groom, {});
    if (!simulation) throw std::runtime_error(simulation.error().message());
    for (int f = 0; f < 60; ++f) simulation->step(kFrame, pose);
    return {simulation->positions_ws().begin(), simulation->positions_ws().end()};
}

float farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    float most = 0;
    for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, (a[p] - b[p]).norm());
    return most;
}

TEST(SkinSpheres, AreThoseThatLieInTheSkinOrBulgeALittle) {
    const auto told = [](std::vector<CollisionSphere> spheres) {
        const auto ofSkin = skinSpheresOf(ballWith(std::move(spheres)));
        return std::vector<int>(ofSkin.begin(), ofSkin.end());
    };
    // The ball has 10 cm. What bulges by 20 mm of 90 mm is of the skin, by 30 mm is none, as a bun is.
    EXPECT_EQ(told({sphereAt({0, 0, 0}, 0.05f), sphereAt({0, 0.01f, 0}, 0.1f), sphereAt({0, 0.03f, 0}, 0.09f),
                    sphereAt({0, 0.04f, 0}, 0.09f)}),
              (std::vector{1, 1, 1, 0}));
    // A hat around all of it, a hand outside that lies on it, and no sphere at all.
    EXPECT_EQ(told({sphereAt({0, 0, 0}, 0.14f), sphereAt({0, 0.14f, 0}, 0.05f),
                    sphereAt({0, 0.11f, 0}, 0.05f), sphereAt({0, 0, 0}, -1.0f)}),
              (std::vector{0, 0, 0, 0}));
    // Hats so wide that the table of distances ends inside them.
    EXPECT_EQ(told({sphereAt({0, 0, 0}, 0.2f), sphereAt({0, 0.02f, 0}, 0.3f)}), (std::vector{0, 0}));
    // Both ends lie inside; so does all between them.
    EXPECT_EQ(told({sphereAt({0, -0.04f, 0}, 0.05f, 1), sphereAt({0, 0.04f, 0}, 0.05f)}),
              (std::vector{1, 1}));
    // One end is a hand.
    EXPECT_EQ(told({sphereAt({0, 0, 0}, 0.05f, 1), sphereAt({0, 0.2f, 0}, 0.05f)}), (std::vector{0, 0}));
    // A chain of which the last is a hand: a capsule that pushes has two ends that do, in whichever order.
    EXPECT_EQ(told({sphereAt({0, 0, 0}, 0.05f, 1), sphereAt({0, 0.02f, 0}, 0.05f, 2),
                    sphereAt({0, 0.2f, 0}, 0.05f)}),
              (std::vector{0, 0, 0}));
    Groom bare = ballWith({sphereAt({0, 0, 0}, 0.05f)});
    bare.body.reset();
    EXPECT_TRUE(skinSpheresOf(bare).empty());
}

/// Between two balls of skin a capsule bridges what neither of its ends does.
TEST(SkinSpheres, ACapsuleThatBridgesSkinIsMet) {
    Groom groom = hairyBody();
    const PolygonSoup ball = test::icosphereSoup(4, 0.05f);
    PolygonSoup soup;
    for (const float x : {-0.08f, 0.08f}) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size()),
                   corners = static_cast<std::uint32_t>(soup.corners.size());
        for (const Vec3f& p : ball.positions) soup.positions.emplace_back(p.x() + x, p.y(), p.z());
        for (const std::uint32_t corner : ball.corners) soup.corners.push_back(first + corner);
        for (std::size_t f = 1; f < ball.offsets.size(); ++f)
            soup.offsets.push_back(corners + ball.offsets[f]);
    }
    groom.scalp = std::make_shared<const ScalpMesh>(test::meshOf(soup));
    groom.body.reset();
    groom = test::withBody(std::move(groom));
    groom.spheres = {sphereAt({-0.08f, 0, 0}, 0.05f), sphereAt({0.08f, 0, 0}, 0.05f)};
    EXPECT_EQ(skinSpheresOf(groom), (runtime::Vector<std::uint8_t>{1, 1}));
    groom.spheres[0].joined = 1;
    EXPECT_EQ(skinSpheresOf(groom), (runtime::Vector<std::uint8_t>{0, 0}));
}

TEST(SkinSpheres, PushNothingWhereTheSkinIsMet) {
    const std::vector<Vec3f> skin = settled(ballWith({}));
    const std::vector<CollisionSphere> bulging{sphereAt({0, 0.02f, 0}, 0.09f, 1),
                                               sphereAt({0, 0, 0}, 0.102f)};
    Groom groom = ballWith(bulging);
    EXPECT_EQ(settled(groom), skin) << "to the bit";
    // They are met where the skin is not: without it, by springs, and as what is no skin.
    Groom bare = groom;
    bare.body.reset();
    EXPECT_GT(farthest(settled(bare), skin), 5e-3f);
    groom.simulation.strandModel = bare.simulation.strandModel = runtime::StrandModel::springs;
    groom.simulation.substeps = bare.simulation.substeps = 8;
    EXPECT_EQ(settled(groom), settled(bare));
    EXPECT_GT(farthest(settled(ballWith({sphereAt({0, 0, 0}, 0.14f)})), skin), 0.02f) << "a hat";
    EXPECT_GT(farthest(settled(ballWith({sphereAt({0, 0.14f, 0}, 0.05f)})), skin), 0.02f) << "a hand";
}

TEST(SkinSpheres, AreNotWhatHairIsInside) {
    auto simulation = Simulation::make(ballWith({sphereAt({0, 0.02f, 0}, 0.09f)}), {});
    ASSERT_TRUE(simulation);
    for (int f = 0; f < 10; ++f) simulation->step(kFrame, HeadPose{});
    EXPECT_EQ(simulation->stats().maxPenetrationMm, 0);
    auto hat = Simulation::make(ballWith({sphereAt({0, 0, 0}, 0.14f)}), {});
    ASSERT_TRUE(hat);
    hat->step(kFrame, HeadPose{});
    EXPECT_GT(hat->stats().maxPenetrationMm, 10);
}

TEST(SkinSpheres, KeepOffTheWindStill) {
    Groom groom = ballWith({sphereAt({0, 0, 0}, 0.1f)});
    groom.simulation.windShelter = 1;
    HeadPose windy;
    windy.wind_ws = Vec3f(6, 0, 0);
    const std::vector<Vec3f> sheltered = settled(groom, windy);
    groom.spheres.clear();
    EXPECT_GT(farthest(settled(groom, windy), sheltered), 5e-3f);
}

/// In the window spheres are dragged while hair moves.
TEST(SkinSpheres, AreToldAgainWhenSpheresChange) {
    Groom groom = ballWith({sphereAt({0, 0, 0}, 0.1f)});
    auto simulation = Simulation::make(groom, {});
    ASSERT_TRUE(simulation);
    for (int f = 0; f < 30; ++f) simulation->step(kFrame, HeadPose{});
    const std::vector<Vec3f> before(simulation->positions_ws().begin(), simulation->positions_ws().end());
    simulation->setSpheres({sphereAt({0, 0, 0}, 0.14f)});
    for (int f = 0; f < 60; ++f) simulation->step(kFrame, HeadPose{});
    const std::vector<Vec3f> after(simulation->positions_ws().begin(), simulation->positions_ws().end());
    EXPECT_GT(farthest(before, after), 0.02f);
}

/// A script has them in the world, wherever the head is.
TEST(SkinSpheres, OfWhichNobodyKnowsWhereTheyRestPush) {
    const std::vector<CollisionSphere> bulging{sphereAt({0, 0.02f, 0}, 0.09f)};
    const auto settledWith = [&](bool atRest) {
        auto simulation = Simulation::make(ballWith({}), {});
        EXPECT_TRUE(simulation);
        simulation->setSpheres(bulging, atRest);
        for (int f = 0; f < 60; ++f) simulation->step(kFrame, HeadPose{});
        return std::vector<Vec3f>(simulation->positions_ws().begin(), simulation->positions_ws().end());
    };
    const std::vector<Vec3f> skin = settled(ballWith({}));
    EXPECT_EQ(settledWith(true), skin);
    EXPECT_GT(farthest(settledWith(false), skin), 5e-3f);
}

}  // namespace
}  // namespace hairloom
