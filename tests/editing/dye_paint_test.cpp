// SPDX-License-Identifier: GPL-3.0-or-later
// The brush that dyes hair.

#include <gmock/gmock.h>

#include "core/groom/point_dye.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

TEST(DyePaint, DyesWhatItReachesFromRootToTipAndTurnsTheDyeOn) {
    TopStrand top;
    ASSERT_EQ(top.document.groom().material.dyeStrength, 0);
    Stroke stroke = top.at("dye_paint", {top.points()[8]}, 0.03f);
    stroke.settings.falloff = BrushCurve::falloff("constant");
    stroke.settings.parameters = {{"amount", 0.75f}};
    Part heard = Part::None;
    const Subscription subscription =
        top.document.observe([&](const Change& change) { heard = heard | change.parts; });
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_TRUE(contains(heard, Part::Dye));
    EXPECT_TRUE(contains(heard, Part::Material));
    EXPECT_FALSE(contains(heard, Part::Points));
    const auto valueAt = [&](std::size_t point) {
        const Groom& groom = top.document.groom();
        return groom.pointAttributes.view<float>(attribute::kPointDye)[groom.offsets[top.strand] + point];
    };
    EXPECT_EQ(top.document.groom().material.dyeStrength, 1);
    for (std::size_t p = 0; p < 16; ++p) {
        const float away = (top.points()[p] - top.points()[8]).norm();
        if (std::abs(away - 0.03f) > 0.005f) {
            EXPECT_EQ(valueAt(p), away < 0.03f ? 0.75f : 0.0f) << p;
        }
    }
    Stroke more = stroke;
    more.settings.parameters["amount"] = 1;
    more.settings.strength = 0.5f;
    more.dabs[0].strength = 0.5f;
    ASSERT_TRUE(top.document.replay(more));
    EXPECT_FLOAT_EQ(valueAt(8), 0.875f);
    Stroke off = stroke;
    off.settings.invert = true;
    ASSERT_TRUE(top.document.replay(off));
    EXPECT_EQ(valueAt(8), 0);
    while (top.document.undo()) {
    }
    EXPECT_FALSE(top.document.groom().pointAttributes.has(attribute::kPointDye));
    EXPECT_EQ(top.document.groom().material.dyeStrength, 0);
}

TEST(DyePaint, FollowsTheProfileAndReachesRoots) {
    TopStrand top;
    Stroke tips = top.at("dye_paint", {top.points()[8]}, 0.2f);
    tips.settings.falloff = BrushCurve::falloff("constant");
    tips.settings.profile = BrushCurve({0, 1});
    ASSERT_TRUE(top.document.replay(tips));
    const auto mask = top.document.groom().pointAttributes.view<float>(attribute::kPointDye);
    for (std::size_t s = 0; s < 300; s += 23) {
        for (std::size_t p = 0; p < 16; ++p) {
            if ((top.document.groom().strand(s)[p] - top.points()[8]).norm() < 0.18f) {
                EXPECT_NEAR(mask[16 * s + p], static_cast<float>(p) / 15, 1e-6f);
            }
        }
    }
    TopStrand other;
    ASSERT_TRUE(other.document.replay(other.at("dye_paint", {other.points()[0]}, 0.01f)));
    EXPECT_EQ(other.document.groom().pointAttributes.view<float>(
                  attribute::kPointDye)[other.document.groom().offsets[other.strand]],
              1);
}

TEST(DyePaint, BeginsWithWhatTheHairShows) {
    const auto first = [](const Groom& groom) {
        return groom.pointAttributes.view<float>(attribute::kPointDye);
    };
    // Without a mask all is dyed, and the brush can only take dye off.
    Groom all = hairOnHead();
    all.material.dyeStrength = 0.4f;
    Document document(all);
    Stroke stroke = strokeFor("dye_paint");
    ASSERT_TRUE(document.replay(stroke));
    EXPECT_FALSE(document.canUndo());
    EXPECT_FALSE(document.groom().pointAttributes.has(attribute::kPointDye));
    stroke.settings.invert = true;
    ASSERT_TRUE(document.replay(stroke));
    EXPECT_EQ(document.groom().material.dyeStrength, 0.4f);
    EXPECT_THAT(first(document.groom()), testing::Contains(1.0f));
    EXPECT_THAT(first(document.groom()), testing::Contains(testing::Lt(0.5f)));
    // A strand's own mask is that of its points.
    Groom masked = all;
    std::vector<float> mask(300);
    for (std::size_t s = 0; s < 300; ++s) mask[s] = static_cast<float>(s) / 300;
    masked.strandAttributes.set(attribute::kDye, mask);
    Document dyed(masked);
    ASSERT_TRUE(dyed.replay(stroke));
    std::size_t kept = 0;
    for (std::size_t s = 0; s < 300; ++s) kept += first(dyed.groom())[16 * s] == mask[s] ? 1 : 0;
    EXPECT_GT(kept, 100u);
}

TEST(DyePaint, SmoothingBringsTheMaskToItsMean) {
    TopStrand top;
    ASSERT_TRUE(top.document.replay(top.at("dye_paint", {top.points()[8]}, 0.02f)));
    const auto spread = [&] {
        float minimum = 1, maximum = 0;
        const Groom& groom = top.document.groom();
        const auto mask = groom.pointAttributes.view<float>(attribute::kPointDye);
        for (std::size_t p = 0; p < 16; ++p) {
            if ((top.points()[p] - top.points()[8]).norm() > 0.025f) continue;
            const float value = mask[groom.offsets[top.strand] + p];
            minimum = std::min(minimum, value);
            maximum = std::max(maximum, value);
        }
        return maximum - minimum;
    };
    const float before = spread();
    ASSERT_GT(before, 0.5f);
    Stroke smooth = top.at("dye_paint", {top.points()[8], top.points()[8], top.points()[8]}, 0.06f);
    smooth.settings.parameters = {{"smooth", 1}};
    for (Dab& dab : smooth.dabs) dab.strength = 0.5f;
    ASSERT_TRUE(top.document.replay(smooth));
    EXPECT_LT(spread(), 0.5f * before);
}

}  // namespace
}  // namespace hairloom::editing
