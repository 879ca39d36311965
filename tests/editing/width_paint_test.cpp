// SPDX-License-Identifier: GPL-3.0-or-later
// The brush that paints how thick hair is.

#include <gmock/gmock.h>

#include "core/groom/point_width.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

Stroke widthStroke(const TopStrand& top, float width) {
    Stroke stroke = top.at("width_paint", {top.points()[8]}, 0.03f);
    stroke.settings.falloff = BrushCurve::falloff("constant");
    stroke.settings.parameters = {{"width", width}};
    return stroke;
}

TEST(WidthPaint, MultipliesTheWidthOfWhatItReaches) {
    TopStrand top;
    Part heard = Part::None;
    const Subscription subscription =
        top.document.observe([&](const Change& change) { heard = heard | change.parts; });
    ASSERT_TRUE(top.document.replay(widthStroke(top, 3)));
    EXPECT_TRUE(contains(heard, Part::Widths));
    EXPECT_FALSE(contains(heard, Part::Points | Part::Material));
    const auto factorAt = [&](std::size_t point) {
        const Groom& groom = top.document.groom();
        return widened(1e-5f, widthChanges(groom)[groom.offsets[top.strand] + point]) / 1e-5f;
    };
    for (std::size_t p = 0; p < 16; ++p) {
        const float away = (top.points()[p] - top.points()[8]).norm();
        if (std::abs(away - 0.03f) > 0.005f) {
            EXPECT_NEAR(factorAt(p), away < 0.03f ? 3 : 1, 1e-5f) << p;
        }
    }
    Stroke thinner = widthStroke(top, 4);
    thinner.settings.invert = true;
    ASSERT_TRUE(top.document.replay(thinner));
    EXPECT_NEAR(factorAt(8), 0.25f, 1e-5f);
    ASSERT_TRUE(top.document.replay(widthStroke(top, 1)));
    EXPECT_NEAR(factorAt(8), 1, 1e-5f);
    EXPECT_FALSE(hasErrors(validate(top.document.groom())));
    while (top.document.undo()) {
    }
    EXPECT_FALSE(top.document.groom().pointAttributes.has(attribute::kWidthChange));
}

TEST(WidthPaint, FollowsTheProfileAndSmooths) {
    TopStrand top;
    Stroke tips = widthStroke(top, 5);
    tips.settings.profile = BrushCurve({0, 1});
    for (Dab& dab : tips.dabs) dab.radius = 0.2f;
    ASSERT_TRUE(top.document.replay(tips));
    const auto changeAt = [&](std::size_t point) {
        return widthChanges(top.document.groom())[top.document.groom().offsets[top.strand] + point];
    };
    EXPECT_NEAR(changeAt(0), 0, 1e-6f);
    EXPECT_NEAR(changeAt(15), 4, 1e-5f);
    EXPECT_NEAR(changeAt(5), 4.0f / 3, 1e-5f);
    const float before = changeAt(15) - changeAt(0);
    Stroke smooth = tips;
    smooth.settings.profile = BrushCurve();
    smooth.settings.parameters = {{"smooth", 1}};
    for (Dab& dab : smooth.dabs) dab.strength = 0.5f;
    ASSERT_TRUE(top.document.replay(smooth));
    EXPECT_NEAR(changeAt(15) - changeAt(0), 0.5f * before, 1e-4f);
}

TEST(WidthPaint, HairThatComesLaterHasTheWidthItsMaterialSays) {
    Document document(hairOnHead());
    Stroke stroke = strokeFor("width_paint");
    stroke.settings.radius = 0.3f;
    for (Dab& dab : stroke.dabs) dab.radius = 0.3f;
    ASSERT_TRUE(document.replay(stroke));
    Stroke add = strokeFor("add");
    add.settings.parameters = {{"reach", 0}};
    ASSERT_TRUE(document.replay(add));
    const Groom& groom = document.groom();
    ASSERT_GT(groom.strandCount(), 300u);
    EXPECT_THAT(widthChanges(groom).subspan(groom.offsets[300]), testing::Each(0.0f));
}

TEST(WidthChange, IsBoundedAndNeverMakesARadiusThatCannotBe) {
    EXPECT_EQ(widened(4e-5f, 0), 4e-5f);
    EXPECT_EQ(widened(4e-5f, -1), 0);
    EXPECT_EQ(widened(4e-5f, -7), 0);
    EXPECT_EQ(widened(4e-5f, std::numeric_limits<float>::quiet_NaN()), 4e-5f);
    EXPECT_FLOAT_EQ(widened(4e-5f, std::numeric_limits<float>::infinity()), 4e-4f);
    EXPECT_EQ(widened(0.4f, 9), 0.5f);
    EXPECT_EQ(widened(0.9f, 9), 0.9f);
    Groom groom = hairOnHead();
    std::vector<float> changes(groom.pointCount(), 0);
    changes[7] = 12;
    groom.pointAttributes.set(attribute::kWidthChange, changes);
    const auto findings = validate(groom);
    ASSERT_TRUE(hasErrors(findings));
    EXPECT_THAT(findings.front().what, testing::HasSubstr("width"));
}

}  // namespace
}  // namespace hairloom::editing
