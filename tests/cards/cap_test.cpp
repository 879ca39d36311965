// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/cap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/cards/rig.h"
#include "tests/cards/card_samples.h"

namespace hairloom::cards {
namespace {

constexpr float kBall = 0.1f;  // metres, radius of the ball that samples stand on
constexpr float kTolerance = 0.0003f;
constexpr float kShownLength = 0.012f;  // metres of a hair

std::vector<CapChart> capOf(const Hair& hair, float tolerance) {
    auto cap = makeCap(hair, tolerance, nullptr);
    EXPECT_TRUE(cap);
    return cap ? std::move(*cap) : std::vector<CapChart>{};
}

/// Where a line from the middle of the ball meets a triangle, as a factor; negative: nowhere.
float hit(const Vec3f& direction, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    Eigen::Matrix3f columns;
    columns << a, b, c;
    const Vec3f shares = columns.fullPivLu().solve(direction);
    constexpr float kEdge = -1e-4f;
    return shares.minCoeff() < kEdge ? -1 : 1 / shares.sum();
}

/// Distances from the middle at which the cap lies in a direction.
std::vector<float> distances(const std::vector<CapChart>& cap, const Vec3f& direction) {
    std::vector<float> found;
    for (const CapChart& chart : cap) {
        for (std::size_t i = 0; i + 2 < chart.indices.size(); i += 3) {
            const auto at = [&](std::size_t k) { return chart.vertices[chart.indices[i + k]].position_ws; };
            const float distance = hit(direction, at(0), at(1), at(2));
            if (distance > 0) found.push_back(distance);
        }
    }
    return found;
}

TEST(Cap, LiesJustAboveTheSkinAtAllRoots) {
    const Hair hair = ballHair(1500);
    const auto cap = capOf(hair, kTolerance);
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        const auto found = distances(cap, hair.rootNormals_ws[s]);
        ASSERT_FALSE(found.empty()) << "no seam at root " << s;
        for (const float distance : found) {
            EXPECT_GT(distance, kBall) << "skin does not show through at root " << s;
            EXPECT_LT(distance, kBall + 0.003f) << "no flap at root " << s;
        }
    }
}

TEST(Cap, FacesOutwards) {
    for (const CapChart& chart : capOf(ballHair(1500), kTolerance)) {
        for (std::size_t i = 0; i + 2 < chart.indices.size(); i += 3) {
            const auto at = [&](std::size_t k) { return chart.vertices[chart.indices[i + k]].position_ws; };
            EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).dot(at(0)), 0);
        }
        for (const CapChart::Vertex& v : chart.vertices)
            EXPECT_GT(v.normal_ws.dot(v.position_ws.normalized()), 0.9f);
    }
}

TEST(Cap, DoesNotHangBetweenSkinAndSkinBehindIt) {
    Hair hair = ballHair(1500);
    const Hair front = hair;
    const Vec3f behind(0, 0, -0.3f);
    const auto points = static_cast<std::uint32_t>(front.positions_ws.size());
    for (std::size_t s = 1; s < front.offsets.size(); ++s) hair.offsets.push_back(points + front.offsets[s]);
    for (const Vec3f& point : front.positions_ws) hair.positions_ws.push_back(point + behind);
    hair.radii.insert(hair.radii.end(), front.radii.begin(), front.radii.end());
    hair.albedo.insert(hair.albedo.end(), front.albedo.begin(), front.albedo.end());
    hair.rootNormals_ws.insert(hair.rootNormals_ws.end(), front.rootNormals_ws.begin(),
                               front.rootNormals_ws.end());
    for (const CapChart& chart : capOf(hair, kTolerance)) {
        for (const std::uint32_t index : chart.indices) {
            const Vec3f& at = chart.vertices[index].position_ws;
            const float off = std::min(std::abs(at.norm() - kBall), std::abs((at - behind).norm() - kBall));
            ASSERT_LT(off, 0.01f) << "a flap at " << at.transpose();
        }
    }
}

TEST(Cap, IsOfFewerTrianglesFartherAway) {
    const auto triangles = [](float tolerance) {
        std::size_t count = 0;
        for (const CapChart& chart : capOf(ballHair(1500), tolerance)) count += chart.indices.size() / 3;
        return count;
    };
    EXPECT_GT(triangles(0.0003f), 2 * triangles(0.0012f));
}

TEST(Cap, StopsWhenItIsCancelled) {
    const std::atomic<bool> cancel{true};
    EXPECT_FALSE(makeCap(ballHair(1500), kTolerance, &cancel));
}

/// Strands of 20 mm on the plane y = 0, `lean` radians off its normal, all one way.
Hair uprightHair(std::uint32_t strands, float lean) {
    Hair hair;
    const Vec3f way(0, std::cos(lean), std::sin(lean));
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (const float along : {0.0f, 0.01f, 0.02f}) {
            hair.positions_ws.emplace_back(Vec3f(0.002f * static_cast<float>(s), 0, 0) + along * way);
            hair.radii.push_back(0.0001f), hair.albedo.emplace_back(0.2f, 0.1f, 0.05f);
        }
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
        hair.rootNormals_ws.emplace_back(0, 1, 0);
    }
    return hair;
}

TEST(Cap, HoldsHairThatStandsUpAsFarAsItHidesSkin) {
    constexpr std::uint32_t kStrands = 40;
    const Hair laid = laidRoots(uprightHair(kStrands, 0));
    Vec3f sum = Vec3f::Zero();
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        const Vec3f way = laid.strand(s).back() - laid.strand(s).front();
        EXPECT_NEAR(way.y(), 0, 1e-6f) << "on the skin";
        EXPECT_NEAR(way.norm(), kShownLength / 2, 1e-5f);
        sum += way;
    }
    EXPECT_LT(sum.norm(), 0.5f * kStrands * kShownLength / 2) << "not all one way";
}

TEST(Cap, HoldsHairThatLeansAsFarAsItLeans) {
    constexpr float kLean = 0.25f;
    const Hair laid = laidRoots(uprightHair(5, kLean));
    for (std::uint32_t s = 0; s < 5; ++s) {
        const Vec3f way = laid.strand(s).back() - laid.strand(s).front();
        EXPECT_LT((way - Vec3f(0, 0, kShownLength * std::sin(kLean))).norm(), 1e-5f);
    }
}

TEST(Cap, IsTransparentBeyondTheHairsAndThinsTowardsThem) {
    const Hair hair = ballHair(6000);  // from 0.3 to 0.98 of the ball's height
    const auto light = HairLight::make(hair, nullptr);
    ASSERT_TRUE(light);
    const Hair laid = laidRoots(hair);
    double within = 0, withinCount = 0, outermost = 0, outermostCount = 0;
    for (const CapChart& chart : capOf(hair, kTolerance)) {
        constexpr std::uint32_t kSide = 200;
        const Picture picture = bakeCap(hair, laid, *light, chart, 1, kSide, kSide);
        for (std::uint32_t y = 0; y < kSide; ++y) {
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const float u = (static_cast<float>(x) + 0.5f) / kSide,
                            v = (static_cast<float>(y) + 0.5f) / kSide;
                const Strip& plane = chart.plane;
                Vec3f at = (1 - v) * plane.centre[0] + v * plane.centre[1] +
                           (2 * u - 1) * plane.halfWidth[0] * plane.cross[0];
                // Straight down onto the ball.
                const Vec3f& out = plane.normal[0];
                at -= at.dot(out) * out;
                if (at.norm() >= 0.9f * kBall) continue;
                at += std::sqrt(kBall * kBall - at.squaredNorm()) * out;
                const float height = at.y() / kBall;
                const Texel& texel = picture.at(x, y);
                EXPECT_GE(texel.along, 0);
                EXPECT_LE(texel.along, 0.12f) << "a twelfth of the length of a hair and a little";
                // The lowest roots are at 0.3, and their hairs are laid downwards.
                if (height < 0.3f - 1.4f * kShownLength / kBall) {
                    EXPECT_EQ(texel.coverage, 0) << "skin beyond the hairs";
                } else if (height > 0.25f && height < 0.295f) {
                    outermost += static_cast<double>(texel.coverage), ++outermostCount;
                } else if (height > 0.4f && height < 0.7f) {
                    within += static_cast<double>(texel.coverage), ++withinCount;
                }
            }
        }
    }
    ASSERT_GT(withinCount, 0);
    ASSERT_GT(outermostCount, 0);
    EXPECT_GT(within / withinCount, 0.1);
    EXPECT_LT(outermost / outermostCount, 0.6 * within / withinCount);
}

TEST(Cap, MovesWithTheHeadAndWearsTexturesOfItsOwn) {
    const Hair hair = ballHair(1500);
    const auto light = HairLight::make(hair, nullptr);
    const auto made = makeCards(hair, *light, {.cards = 20, .textures = 4}, nullptr);
    ASSERT_TRUE(made) << made.error().message();
    const auto rig = makeRig(*made, 4, 3, nullptr);
    ASSERT_TRUE(rig);
    const Binding binding = bind(*rig, *made);
    std::size_t count = 0, expected = 0;
    for (std::size_t v = 0; v < made->mesh.vertices.size(); ++v) {
        const CardVertex& vertex = made->mesh.vertices[v];
        EXPECT_EQ(vertex.card == kOfCap, vertex.texture >= 4u);
        ASSERT_LT(vertex.texture, made->atlas.rects.size());
        if (vertex.card != kOfCap) continue;
        ++count;
        EXPECT_EQ(vertex.hangs, 0);
        EXPECT_EQ(binding.joints[v], (std::array<std::uint16_t, 4>{}));
        EXPECT_EQ(binding.weights[v], Vec4f(1, 0, 0, 0));
    }
    for (const CapChart& chart : made->cap) expected += chart.vertices.size();
    EXPECT_EQ(count, expected);
    EXPECT_GT(count, 0u);
    EXPECT_EQ(made->mesh.vertices[made->mesh.indices[0]].card, kOfCap) << "innermost, so it comes first";
}

TEST(Cap, GoesWithTheLastCard) {
    const Hair hair = ballHair(300);
    const auto light = HairLight::make(hair, nullptr);
    auto made = makeCards(hair, *light, {.cards = 3, .textures = 2}, nullptr);
    ASSERT_TRUE(made);
    for (Card& card : made->cards) card.deleted = true;
    buildMesh(*made);
    EXPECT_TRUE(made->mesh.indices.empty());
}

}  // namespace
}  // namespace hairloom::cards
