// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_cleaning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/curve.h"
#include "core/operations/skin.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom {
namespace {

constexpr float kRadius = 0.1f;

/// Straight out of a ball, from `from` metres off its middle on.
std::vector<Vec3f> ray(int number, float from = kRadius, float length = 0.15f, std::size_t points = 60) {
    const float turn = 2.4f * static_cast<float>(number), height = 0.02f * static_cast<float>(number % 8);
    const Vec3f out = Vec3f(std::cos(turn), 0.3f + height, std::sin(turn)).normalized();
    std::vector<Vec3f> strand;
    for (std::size_t i = 0; i < points; ++i)
        strand.emplace_back((from + length * static_cast<float>(i) / static_cast<float>(points - 1)) * out);
    return strand;
}

struct Hair {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    void add(const std::vector<Vec3f>& strand) {
        positions.insert(positions.end(), strand.begin(), strand.end());
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom onBall() const {
        Groom groom = makeGroom(offsets, positions);
        std::vector<float> labels;
        for (std::size_t p = 0; p < positions.size(); ++p) labels.push_back(static_cast<float>(p));
        groom.pointAttributes.set("label", std::move(labels));
        bindToScalp(groom, std::make_shared<const ScalpMesh>(test::meshOf(test::icosphereSoup(4, kRadius))),
                    {});
        return groom;
    }
};

TEST(HairCleaning, LeavesGoodHairWhereItIs) {
    Hair hair;
    for (int i = 0; i < 20; ++i) hair.add(ray(i, kRadius + 0.0006f));
    Groom groom = hair.onBall();
    const auto done = cleanHair(groom, {.points = 16});
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_EQ(groom.strandCount(), 20u);
    EXPECT_EQ(done->repeated + done->shorter + done->outliers + done->loops + done->broken + done->turned,
              0u);
    for (std::size_t s = 0; s < 20; ++s) {
        ASSERT_EQ(groom.strand(s).size(), 16u);
        EXPECT_LT((groom.strand(s)[15] - ray(static_cast<int>(s), kRadius + 0.0006f)[59]).norm(), 2e-4f);
    }
    EXPECT_TRUE(groom.pointAttributes.has("label"));
}

TEST(HairCleaning, MendsWhatReconstructionsHave) {
    Hair hair;
    for (int i = 0; i < 30; ++i) hair.add(ray(i, kRadius + 0.004f));
    hair.add(ray(3, kRadius + 0.004f));       // again
    hair.add(ray(31, kRadius, 0.001f));       // stubble
    hair.add(ray(32, 0.4f));                  // far off
    hair.add(ray(33, kRadius, 3.0f, 600));    // across the room
    hair.add(ray(34, 0.5f * kRadius, 0.2f));  // begins in the head
    auto turned = ray(35);
    std::ranges::reverse(turned);
    hair.add(turned);
    auto jumps = ray(36);
    for (std::size_t i = 45; i < 60; ++i) jumps[i] += Vec3f(0, 0.3f, 0);
    hair.add(jumps);
    auto loops = ray(37);
    const Vec3f side = loops[1].cross(Vec3f::UnitY()).normalized(),
                along = (loops[1] - loops[0]).normalized();
    std::vector<Vec3f> circle;
    for (int i = 1; i < 20; ++i) {
        const float turn = 2 * kPi * static_cast<float>(i) / 20;
        circle.emplace_back(loops[20] + 0.01f * (std::sin(turn) * along + (1 - std::cos(turn)) * side));
    }
    loops.insert(loops.begin() + 21, circle.begin(), circle.end());
    hair.add(loops);
    Groom groom = hair.onBall();
    const auto done = cleanHair(groom, {.points = 24});
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_EQ(done->repeated, 1u);
    EXPECT_EQ(done->shorter, 1u);
    EXPECT_EQ(done->outliers, 2u);
    EXPECT_EQ(done->turned, 1u);
    EXPECT_EQ(done->broken, 1u);
    EXPECT_EQ(done->loops, 1u);
    ASSERT_EQ(groom.strandCount(), 34u);
    EXPECT_GE(done->snapped, 30u);
    EXPECT_NEAR(done->farthestSnap, 0.004f, 1e-3f);
    const Skin skin(groom.scalp);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto strand = groom.strand(s);
        ASSERT_EQ(strand.size(), 24u);
        EXPECT_LT(std::abs(skin.distanceAt(strand[0]).distance), 1e-5f) << s;
        for (const Vec3f& point : strand) EXPECT_GT(skin.distanceAt(point).distance, -1e-5f) << s;
        EXPECT_GT((strand[23] - strand[0]).norm(), 0.05f) << s << " leads away from the head";
    }
    EXPECT_LT(polylineLength(groom.strand(33)), 0.17f) << "the loop is gone";
}

TEST(HairCleaning, WithoutAHeadItResamplesAndSorts) {
    Hair hair;
    for (int i = 0; i < 10; ++i) hair.add(ray(i));
    hair.add(ray(11, kRadius, 2.5f));
    Groom groom = makeGroom(hair.offsets, hair.positions);
    const auto done = cleanHair(groom, {.points = 12});
    ASSERT_TRUE(done);
    EXPECT_EQ(groom.strandCount(), 10u);
    EXPECT_EQ(groom.pointCount(), 120u);
    EXPECT_EQ(done->snapped, 0u);
}

TEST(HairCleaning, SaysWhereNothingIsLeftAndLeavesTheHair) {
    Hair hair;
    for (int i = 0; i < 5; ++i) hair.add(ray(i, 3.0f));
    Groom groom = hair.onBall();
    const auto done = cleanHair(groom);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message(),
                testing::HasSubstr("no strand is left: 0 are under 3 mm, 5 far away"));
    EXPECT_EQ(groom.strandCount(), 5u);
}

}  // namespace
}  // namespace hairloom
