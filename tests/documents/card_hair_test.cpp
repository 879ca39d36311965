// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/card_hair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/documents/small_head.h"

namespace hairloom {
namespace {

TEST(CardHair, IsWhatPicturesShow) {
    const Groom groom = smallHead();
    const auto hair = cardHair(groom);
    ASSERT_TRUE(hair) << hair.error().message();
    EXPECT_EQ(hair->strandCount(), 4 * groom.strandCount());
    EXPECT_EQ(hair->headPositions_ws.size(), groom.scalp->positions().size());
    for (std::size_t s = 0; s < hair->strandCount(); ++s) {
        EXPECT_GT(hair->rootNormals_ws[s].dot(hair->strand(s)[0].normalized()), 0.9f) << "out of the ball";
        EXPECT_FLOAT_EQ(hair->radii[hair->offsets[s]], groom.material.rootRadius);
    }
}

TEST(CardHair, LeavesOutHiddenStrandsAndSaysWhereNoneIsLeft) {
    Groom groom = smallHead();
    groom.interpolation.followPerGuide = 0;
    std::vector<std::uint8_t> hidden(groom.strandCount(), 0);
    hidden[0] = hidden[3] = 1;
    groom.strandAttributes.set(std::string(attribute::kHidden), hidden);
    const auto hair = cardHair(groom);
    ASSERT_TRUE(hair) << hair.error().message();
    EXPECT_EQ(hair->strandCount(), groom.strandCount() - 2);
    groom.strandAttributes.set(std::string(attribute::kHidden),
                               std::vector<std::uint8_t>(groom.strandCount(), 1));
    const auto none = cardHair(groom);
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), testing::HasSubstr("hidden or of no length"));
}

TEST(CardHair, HasTheColoursOfTheMaterial) {
    Groom groom = smallHead();
    groom.material.rootColour = Vec3f(0.1f, 0.2f, 0.3f);
    groom.material.tipColour = Vec3f(0.6f, 0.5f, 0.4f);
    groom.material.colourVariation = 0;
    const auto hair = cardHair(groom);
    ASSERT_TRUE(hair) << hair.error().message();
    EXPECT_LT((hair->albedo.front() - groom.material.rootColour).norm(), 1e-3f);
    EXPECT_LT((hair->albedo[hair->offsets[1] - 1] - groom.material.tipColour).norm(), 1e-3f);
}

}  // namespace
}  // namespace hairloom
