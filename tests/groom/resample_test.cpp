// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/resample.h"

#include <gtest/gtest.h>

#include "core/geometry/curve.h"
#include "core/groom/validate.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"

namespace hairloom {
namespace {

void expectSound(const Groom& groom) {
    for (const Finding& finding : validate(groom))
        EXPECT_NE(finding.severity, Severity::Error) << finding.what << " at " << finding.where;
}

/// Two strands: one of uneven points on a bent line, one of two points.
Groom unevenHair() {
    Groom groom = makeGroom({0, 4, 6}, {Vec3f(0, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 1.5f, 0),
                                        Vec3f(1.5f, 1.5f, 0), Vec3f(5, 0, 0), Vec3f(5, 2, 0)});
    groom.pointAttributes.set("radius", std::vector<float>{1, 2, 3, 6, 1, 3});
    groom.pointAttributes.set("tag", std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
    return groom;
}

TEST(Resample, SpacesPointsEvenlyAndInterpolatesWhatTheyCarry) {
    Groom groom = unevenHair();
    ASSERT_EQ(*resample(groom, {7}), 2u);
    expectSound(groom);
    ASSERT_EQ(groom.strand(0).size(), 7u);
    ASSERT_EQ(groom.strand(1).size(), 7u);
    // The first is 3 long, so that points stand every half: closed form.
    const std::vector<Vec3f> wanted{Vec3f(0, 0, 0),      Vec3f(0, 0.5f, 0),    Vec3f(0, 1, 0),
                                    Vec3f(0, 1.5f, 0),   Vec3f(0.5f, 1.5f, 0), Vec3f(1, 1.5f, 0),
                                    Vec3f(1.5f, 1.5f, 0)};
    const auto radii = groom.pointAttributes.view<float>("radius");
    const std::vector<float> wantedRadii{1, 1.5f, 2, 3, 4, 5, 6};
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_LT((groom.strand(0)[i] - wanted[i]).norm(), 1e-6f) << i;
        EXPECT_NEAR(radii[i], wantedRadii[i], 1e-6f) << i;
        EXPECT_NEAR(radii[7 + i], 1 + 2 * static_cast<float>(i) / 6, 1e-6f) << i;
    }
    EXPECT_EQ(groom.strand(0)[6], Vec3f(1.5f, 1.5f, 0)) << "ends keep their bits";
    EXPECT_EQ(groom.pointAttributes.view<std::uint8_t>("tag")[6], 4)
        << "whole numbers are those of the nearest";
}

TEST(Resample, TwoPointsAreTheEnds) {
    Groom groom = unevenHair();
    ASSERT_EQ(*resample(groom, {2}), 1u) << "one has two already";
    EXPECT_EQ(groom.strand(0)[0], Vec3f(0, 0, 0));
    EXPECT_EQ(groom.strand(0)[1], Vec3f(1.5f, 1.5f, 0));
    EXPECT_EQ(groom.strand(1)[1], Vec3f(5, 2, 0));
    EXPECT_EQ(*resample(groom, {2}), 0u);
}

TEST(Resample, KeepsFrozenStrandsAndThoseBeyondTheRegion) {
    Groom groom = unevenHair();
    groom.strandAttributes.set(attribute::kFrozen, std::vector<std::uint8_t>{1, 0});
    ASSERT_EQ(*resample(groom, {5}), 1u);
    EXPECT_EQ(groom.strand(0).size(), 4u);
    EXPECT_EQ(groom.strand(0)[2], Vec3f(0, 1.5f, 0));
    EXPECT_EQ(groom.strand(1).size(), 5u);
    Groom region = unevenHair();
    ASSERT_EQ(*resample(region, {5}, {.point = Vec3f(2, 0, 0), .normal = Vec3f(-1, 0, 0)}), 1u);
    EXPECT_EQ(region.strand(0).size(), 5u);
    EXPECT_EQ(region.strand(1).size(), 2u);
}

TEST(Resample, StrandsWithoutLengthStayInPlace) {
    Groom groom = makeGroom({0, 3}, std::vector<Vec3f>(3, Vec3f(1, 2, 3)));
    ASSERT_EQ(*resample(groom, {9}), 1u);
    for (const Vec3f& point : groom.strand(0)) EXPECT_EQ(point, Vec3f(1, 2, 3));
}

TEST(Resample, OperatorsGoAndTheirShapeStays) {
    Groom groom = unevenHair();
    groom.operators = {newOperator("noise"), newOperator(kSculpt)};
    groom.operators[1].number = 1;
    groom.pointAttributes.set(attribute::kBasePosition,
                              std::vector<Vec3f>(groom.positions().begin(), groom.positions().end()));
    groom.pointAttributes.set(sculptAttribute(1), std::vector<Vec3f>(6, Vec3f::Zero()));
    ASSERT_TRUE(resample(groom, {7}));
    EXPECT_TRUE(groom.operators.empty());
    EXPECT_FALSE(groom.pointAttributes.has(attribute::kBasePosition));
    EXPECT_FALSE(groom.pointAttributes.has(sculptAttribute(1)));
    expectSound(groom);
}

TEST(Resample, CountsOutOfRangeAreErrors) {
    Groom groom = unevenHair();
    for (const std::uint32_t points : {0u, 1u, 513u}) EXPECT_FALSE(resample(groom, {points})) << points;
    EXPECT_EQ(groom.strand(0).size(), 4u);
}

}  // namespace
}  // namespace hairloom
