// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/length_constraint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/curve.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

constexpr float kHeadRadius = 0.09f;
const Vec3f kHeadCentre(0, 1.6f, 0);

TEST(LengthConstraint, RestoresLengthsTowardsThePoints) {
    std::vector<Vec3f> points{{0, 0, 0}, {0, 3, 0}, {0, 3, 5}};
    const std::vector<float> lengths{1, 2};
    restoreLengths(points, lengths);
    EXPECT_EQ(points[1], Vec3f(0, 1, 0));
    EXPECT_NEAR((points[2] - points[1]).norm(), 2, 1e-6f);
    EXPECT_NEAR((points[2] - points[1]).normalized().dot(Vec3f(0, 2, 5).normalized()), 1, 1e-6f);

    std::vector<Vec3f> turned{{0, 0, 0}, {0, 3, 0}, {0, 3, 5}};
    restoreLengthsByDirection(turned, lengths);
    EXPECT_LT((turned[2] - Vec3f(0, 1, 2)).norm(), 1e-6f);

    std::vector<Vec3f> collapsed{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    restoreLengths(collapsed, lengths);
    EXPECT_NEAR((collapsed[1] - collapsed[0]).norm(), 1, 1e-6f);
    EXPECT_NEAR((collapsed[2] - collapsed[1]).norm(), 2, 1e-6f);
}

/// Where points are drawn together the strand gets ahead of them; it goes on and does not turn round.
TEST(LengthConstraint, WhatIsDrawnTogetherDoesNotTurnRound) {
    for (const float share : {0.3f, 0.7f, 0.95f}) {
        std::vector<Vec3f> points;
        const std::vector<float> lengths(24, 0.005f);
        for (int i = 0; i < 25; ++i) {
            const float along = 0.005f * share * static_cast<float>(i);
            points.emplace_back(0.01f * std::sin(40 * along), along, 0);
        }
        const float asked = largestTurn(points);
        restoreLengths(points, lengths);
        EXPECT_LT(largestTurn(points), asked + 0.5f) << share;
        for (std::size_t i = 1; i < points.size(); ++i)
            EXPECT_NEAR((points[i] - points[i - 1]).norm(), 0.005f, 1e-7f);
    }
}

/// Hair whose end is carried farther than it reaches follows smoothly and as far as it can.
TEST(LengthConstraint, WhatIsDrawnApartFollowsAndIsSmooth) {
    const std::vector<float> lengths(30, 0.01f);
    std::vector<Vec3f> points, turnedOnly;
    for (int i = 0; i < 31; ++i) {
        const float share = std::clamp((static_cast<float>(i) - 8) / 12, 0.0f, 1.0f);
        points.emplace_back(0.12f * share * share * (3 - 2 * share), 0.01f * static_cast<float>(i), 0);
    }
    const Vec3f wanted = points.back();
    const float asked = largestTurn(points);
    turnedOnly = points;
    restoreLengths(points, lengths);
    restoreLengthsByDirection(turnedOnly, lengths);
    EXPECT_LT((points.back() - wanted).norm(), (turnedOnly.back() - wanted).norm());
    EXPECT_LT(largestTurn(points), asked + 30);
}

TEST(LengthConstraint, WhatFoldsIsSpreadTowardsTheTipAndCurlsStay) {
    std::vector<Vec3f> points;
    for (int i = 0; i < 20; ++i) points.emplace_back(0, 0.01f * static_cast<float>(std::min(i, 20 - i)), 0);
    points[10].x() = 0.001f;
    std::vector<float> lengths, turns;
    measureSegments(points, lengths);
    measureTurns(points, turns);
    const std::vector<Vec3f> folded = points;
    settle(points, lengths, turns, nullptr, 0);
    EXPECT_EQ(points, folded) << "it was so";

    settle(points, lengths, std::vector<float>(points.size(), 1.0f), nullptr, 0);
    EXPECT_LT(largestTurn(points), 28.5f);
    EXPECT_GT(largestTurn(folded), 150);
    for (std::size_t i = 1; i < points.size(); ++i)
        EXPECT_NEAR((points[i] - points[i - 1]).norm(), lengths[i - 1], 1e-6f);
    EXPECT_TRUE(std::equal(points.begin(), points.begin() + 10, folded.begin())) << "before the fold";
    EXPECT_LT((points[19] - points[18]).normalized().y(), -0.99f) << "it leads where it was to";
}

/// Hair that leads straight into the skin bends before it, and lies along it.
TEST(LengthConstraint, WhatMeetsTheSkinBendsBefore) {
    const Skin skin(sphereScalp(kHeadRadius, 4, kHeadCentre));
    std::vector<Vec3f> points;
    for (int i = 0; i < 20; ++i)
        points.push_back(kHeadCentre + Vec3f(0.01f, kHeadRadius + 0.1f - 0.01f * static_cast<float>(i), 0));
    std::vector<float> lengths, turns;
    measureSegments(points, lengths);
    measureTurns(points, turns);
    std::vector<Vec3f> pushed = points;
    ASSERT_TRUE(keepOutside(pushed, lengths, skin, 0.001f));
    EXPECT_GT(largestTurn(pushed), 40);
    settle(points, lengths, turns, &skin, 0.001f);
    EXPECT_LT(largestTurn(points), 30);
    for (std::size_t i = 1; i < points.size(); ++i) {
        EXPECT_NEAR((points[i] - points[i - 1]).norm(), 0.01f, 1e-5f);
        EXPECT_GT(skin.distanceAt(points[i]).distance, 0.0009f);
    }
}

/// Answers as little as a query up to a distance may.
class LazySkin final : public SkinQuery {
  public:
    explicit LazySkin(const Skin& skin) : skin_(skin) {}
    SkinDistance distanceAt(const Vec3f& point) const override { return skin_.distanceAt(point); }
    SkinDistance distanceUpTo(const Vec3f& point, float enough) const override {
        const SkinDistance whole = skin_.distanceAt(point);
        if (!(whole.distance > enough)) return whole;
        return {0.5f * (enough + whole.distance), Vec3f::Constant(std::numeric_limits<float>::quiet_NaN())};
    }

  private:
    const Skin& skin_;
};

/// From a root on a head of radius kHeadRadius: a tangle that runs through it, with segments of many lengths,
/// some of none and some that turn back.
std::vector<Vec3f> tangle(Random& random) {
    const auto vector = [&] {
        const float x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        return Vec3f(x, y, random.uniform(-1, 1));
    };
    std::vector<Vec3f> points{kHeadCentre + vector().normalized() * kHeadRadius};
    const float longest = random.uniform(0.002f, 0.05f);
    for (int i = 0; i < 20; ++i) {
        Vec3f step = vector() * longest;
        if (random.below(8) == 0) step.setZero();
        if (random.below(8) == 0) step = 0.3f * (kHeadCentre - points.back());
        if (random.below(8) == 0 && i > 0) step = points[points.size() - 2] - points.back();
        points.push_back(points.back() + step);
    }
    return points;
}

TEST(LengthConstraint, KeepsTanglesOutsideAndAtTheirLengths) {
    const Skin skin(sphereScalp(kHeadRadius, 4, kHeadCentre));
    const LazySkin lazy(skin);
    constexpr float kClearance = 0.0015f;
    Random random(3);
    std::size_t moved = 0;
    for (int i = 0; i < 300; ++i) {
        const std::vector<Vec3f> before = tangle(random);
        const std::size_t first = 1 + random.below(4);
        std::vector<float> lengths;
        measureSegments(before, lengths);
        std::vector<Vec3f> whole = before, shortcut = before;
        moved += keepOutside(whole, lengths, skin, kClearance, first) ? 1 : 0;
        keepOutside(shortcut, lengths, lazy, kClearance, first);
        ASSERT_EQ(whole, shortcut) << "what a query leaves out makes no difference";
        float arc = 0;
        bool isFree = true;  // what lies before `first` is outside as well
        for (std::size_t p = 1; p < whole.size(); ++p) {
            arc += lengths[p - 1];
            if (p < first) {
                ASSERT_EQ(whole[p], before[p]);
                isFree = isFree && skin.distanceAt(whole[p]).distance >= std::min(kClearance, 0.5f * arc);
                continue;
            }
            ASSERT_NEAR((whole[p] - whole[p - 1]).norm(), lengths[p - 1], 1e-6f + 1e-5f * lengths[p - 1]);
            if (isFree) {
                ASSERT_GT(skin.distanceAt(whole[p]).distance, std::min(kClearance, 0.5f * arc) - 1.1e-4f)
                    << "tangle " << i << ", point " << p;
            }
        }
    }
    EXPECT_GT(moved, 200u);
}

/// A plane is reached by turning once, by no more than has to be.
TEST(LengthConstraint, TurnsASegmentOutByTheLeastAngle) {
    struct Floor final : SkinQuery {
        SkinDistance distanceAt(const Vec3f& point) const override { return {point.y(), Vec3f::UnitY()}; }
    };
    const Vec3f from(0, 0.002f, 0);
    const Vec3f down = Vec3f(0.6f, -0.8f, 0);
    const Vec3f end = placeOutside(Floor(), from, down, 0.01f, 0.001f);
    EXPECT_NEAR(end.y(), 0.001f, 1.01e-5f);
    EXPECT_NEAR((end - from).norm(), 0.01f, 1e-7f);
    EXPECT_NEAR(end.z(), 0, 1e-9f);
    EXPECT_GT(end.x(), 0.0099f);
    const Vec3f free = placeOutside(Floor(), from, Vec3f::UnitX(), 0.01f, 0.001f);
    EXPECT_EQ(free, Vec3f(0.01f, 0.002f, 0));
}

}  // namespace
}  // namespace hairloom
