// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/drawn_depth.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/parallel.h"
#include "core/geometry/mesh_solid.h"
#include "core/interpolation/follow_hairs.h"
#include "tests/documents/small_head.h"

namespace hairloom {
namespace {

constexpr float kRadius = 0.1f;

/// One strand of three points beside the ball, rooted at its side.
Groom besideBall(const Vec3f& middle, const Vec3f& tip) {
    const auto ball = std::make_shared<const ScalpMesh>(shapes::meshOf(shapes::icosphere(5, kRadius)));
    Groom groom = makeGroom({0, 3}, {Vec3f(kRadius, 0, 0), middle, tip});
    groom.scalp = ball;
    return groom;
}

DrawnDepth depthOf(const Groom& groom, std::span<const Vec3f> positions, const HeadPose& pose = {}) {
    auto meter = DrawnDepthMeter::make(groom);
    if (!meter) throw std::runtime_error(meter.error().message());
    meter->add(7, positions, {}, pose);
    return meter->result();
}

TEST(DrawnDepth, CountsTheCurveBetweenPoints) {
    const Groom groom = besideBall({0.2f, 0, 0}, {0.2f, 0.1f, 0});
    // Both ends outside; the way between them leads through the ball by 2 cm.
    const std::vector<Vec3f> moved{{kRadius, 0, 0}, {0.15f, 0.08f, 0}, {-0.15f, 0.08f, 0}};
    const DrawnDepth depth = depthOf(groom, moved);
    EXPECT_EQ(depth.authored, 0);
    EXPECT_GT(depth.deepest, 0.015);
    EXPECT_LT(depth.deepest, 0.04);
    EXPECT_EQ(depth.deepest, depth.deepestGuide);
    EXPECT_EQ(depth.deepestFrame, 7u);
    EXPECT_GT(depth.shareInside, 0.1);
    EXPECT_LT(depth.shareInside, 0.8);
}

TEST(DrawnDepth, DoesNotCountWhatIsAuthoredNorTheRoot) {
    // Authored 7.5 mm deep at its middle point, and deeper before it.
    const Groom groom = besideBall({0.092f, 0.01f, 0}, {0.15f, 0.08f, 0});
    const std::vector<Vec3f> rest(groom.positions().begin(), groom.positions().end());
    const DrawnDepth still = depthOf(groom, rest);
    EXPECT_GT(still.authored, 0.0075);
    EXPECT_LT(still.authored, 0.012);
    EXPECT_EQ(still.deepest, 0);
    EXPECT_EQ(still.shareInside, 0);
    EXPECT_FALSE(still.deepestFrame);
    std::vector<Vec3f> moved = rest;
    moved[1].x() -= 0.003f;
    EXPECT_NEAR(depthOf(groom, moved).deepest, 0.003, 5e-4);
    // A root below the skin: the first 5 mm are free.
    const Groom rooted = besideBall({0.2f, 0, 0}, {0.3f, 0, 0});
    std::vector<Vec3f> sunk(rooted.positions().begin(), rooted.positions().end());
    for (Vec3f& point : sunk) point.x() -= 0.004f;
    EXPECT_EQ(depthOf(rooted, sunk).deepest, 0);
}

TEST(DrawnDepth, IsOfTheHeadInItsPose) {
    const Groom groom = besideBall({0.2f, 0, 0}, {0.2f, 0.1f, 0});
    HeadPose pose;
    pose.head_ws.translation() = Vec3f(1, 2, 3);
    std::vector<Vec3f> moved;
    for (const Vec3f& point : groom.positions()) moved.push_back(point + Vec3f(1, 2, 3));
    EXPECT_EQ(depthOf(groom, moved, pose).deepest, 0);
    EXPECT_EQ(depthOf(groom, groom.positions(), pose).deepest, 0) << "far from the head";
    // Of a mesh that deforms: as large again.
    HeadPose grown;
    for (const Vec3f& p : groom.scalp->positions()) grown.scalpPositions_ws.push_back(2.2f * p);
    EXPECT_GT(depthOf(groom, groom.positions(), grown).deepest, 0.01);
}

TEST(DrawnDepth, FollowHairsCountAndGuidesAreToldApart) {
    const Groom groom = smallHead();
    std::vector<Vec3f> moved(groom.positions().begin(), groom.positions().end());
    const DrawnDepth still = depthOf(groom, moved);
    EXPECT_EQ(still.deepest, 0);
    // Every guide laid on the ball, 1 mm above it: wisps reach below.
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto strand = groom.strand(s);
        const Vec3f out = strand[0].normalized(), along = out.unitOrthogonal();
        for (std::size_t p = 1; p < strand.size(); ++p) {
            const float angle = 0.02f * static_cast<float>(p) / kRadius;
            moved[groom.offsets[s] + p] =
                (kRadius + 0.001f) * (std::cos(angle) * out + std::sin(angle) * along);
        }
    }
    const DrawnDepth laid = depthOf(groom, moved);
    EXPECT_LT(laid.deepestGuide, 0.001);
    EXPECT_GT(laid.deepest, 0.003) << "wisps are 2 cm wide";
    EXPECT_GT(laid.shareInside, 0.1);

    // Against a search at every place of the same hairs, point by point.
    const auto bindings = bindFollowHairs(groom, groom.interpolation);
    ASSERT_TRUE(bindings);
    Groom laidGroom = groom;
    laidGroom.pointAttributes.set(attribute::kPosition, moved);
    std::vector<Vec3f> hairs(bindings->hairCount() * bindings->pointsPerHair);
    const auto guides = guidePositions(laidGroom, *bindings);
    ASSERT_TRUE(evaluateFollowHairs(*bindings, {guides, {}, {}}, hairs));
    const MeshSolid ball(groom.scalp->positions(), groom.scalp->triangles());
    float deepestPoint = 0;
    for (std::size_t h = 0; h < bindings->hairCount(); ++h) {
        for (std::size_t p = 1; p < bindings->pointsPerHair; ++p)
            deepestPoint =
                std::max(deepestPoint, -ball.signedDistance(hairs[h * bindings->pointsPerHair + p]));
    }
    EXPECT_GE(laid.deepest + 2e-5, static_cast<double>(deepestPoint));
    EXPECT_LT(laid.deepest, static_cast<double>(deepestPoint) + 0.004) << "what the curve adds";
}

TEST(DrawnDepth, IsTheSameForAnyNumberOfThreads) {
    const Groom groom = smallHead(16);
    const SkinnedNod nod(groom);
    std::vector<Vec3f> sunk;
    for (const Vec3f& point : groom.positions()) sunk.push_back(0.9f * point);
    const auto run = [&](std::size_t threads) {
        setThreadCount(threads);
        auto meter = DrawnDepthMeter::make(groom);
        EXPECT_TRUE(meter);
        for (int frame = 0; frame < 6; ++frame)
            meter->add(static_cast<std::uint64_t>(frame), sunk, {},
                       nod.poseAt(0.05f * static_cast<float>(frame)));
        setThreadCount(0);
        return meter->result();
    };
    const DrawnDepth one = run(1), four = run(4);
    EXPECT_EQ(one.deepest, four.deepest);
    EXPECT_EQ(one.shareInside, four.shareInside);
    EXPECT_EQ(one.deepestFrame, four.deepestFrame);
    EXPECT_GT(one.deepest, 0.001);
}

TEST(DrawnDepth, RefusesHeadsWithoutInside) {
    Groom groom = smallHead();
    groom.scalp = nullptr;
    EXPECT_FALSE(DrawnDepthMeter::make(groom));
    groom = smallHead();
    groom.scalp = std::make_shared<const ScalpMesh>(shapes::meshOf(shapes::grid(4, 1, {})));
    const auto sheet = DrawnDepthMeter::make(groom);
    ASSERT_FALSE(sheet);
    EXPECT_NE(sheet.error().message().find("encloses no space"), std::string::npos);
}

TEST(DrawnDepth, LeavesOutHairThatIsLost) {
    const Groom groom = besideBall({0.2f, 0, 0}, {0.2f, 0.1f, 0});
    std::vector<Vec3f> lost(groom.positions().begin(), groom.positions().end());
    lost[1].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(depthOf(groom, lost).deepest, 0);
}

}  // namespace
}  // namespace hairloom
