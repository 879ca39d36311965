// SPDX-License-Identifier: GPL-3.0-or-later
// The brush that paints where operators act.

#include <gmock/gmock.h>

#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

float valueOf(const TopStrand& top, const char* attribute) {
    const auto mask = top.document.groom().strandAttributes.view<float>(attribute);
    return mask.empty() ? -1 : mask[top.strand];
}

TEST(MaskPaint, PaintsOneValueAStrandAndIsUndone) {
    TopStrand top;
    Stroke stroke = top.at("mask_paint", {top.points()[8]}, 0.03f);
    stroke.settings.falloff = BrushCurve::falloff("constant");
    stroke.settings.parameters = {{"mask", 3}, {"value", 0.75f}};
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_FLOAT_EQ(valueOf(top, "mask.3"), 0.75f);
    EXPECT_EQ(valueOf(top, "mask.1"), -1);
    stroke.settings.parameters["value"] = 1;
    stroke.settings.strength = 0.5f;
    stroke.dabs[0].strength = 0.5f;
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_FLOAT_EQ(valueOf(top, "mask.3"), 0.875f);
    stroke.settings.invert = true;
    stroke.dabs[0].strength = 1;
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_EQ(valueOf(top, "mask.3"), 0);
    while (top.document.undo()) {
    }
    EXPECT_FALSE(top.document.groom().strandAttributes.has("mask.3"));
    while (top.document.redo()) {
    }
    EXPECT_EQ(valueOf(top, "mask.3"), 0);
}

TEST(MaskPaint, TakesStrandsByTheirRootsWhereAsked) {
    TopStrand top;
    Stroke stroke = top.at("mask_paint", {top.points()[15]}, 0.02f);
    stroke.settings.parameters = {{"roots", 1}};
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_FALSE(top.document.canUndo()) << "no root lies at a tip";
    stroke = top.at("mask_paint", {top.points()[0]}, 0.02f);
    stroke.settings.parameters = {{"roots", 1}};
    ASSERT_TRUE(top.document.replay(stroke));
    EXPECT_EQ(valueOf(top, "mask.1"), 1);
}

TEST(MaskPaint, AStrokeRunsTheOperatorsThatHaveTheMaskInOneStep) {
    TopStrand top;
    Operator curl = newOperator("curl");
    Mask mask;
    mask.map = MaskMap::mask1;
    setMaskOf(curl, mask);
    auto command = addOperator(top.document.model(), 0, curl);
    ASSERT_TRUE(command) << command.error().message();
    top.document.perform(std::move(*command));
    const std::vector<Vec3f> straight(top.points().begin(), top.points().end());
    const std::size_t steps = top.document.history().doneCount();
    ASSERT_TRUE(top.document.replay(top.at("mask_paint", {top.points()[8]}, 0.03f)));
    EXPECT_EQ(top.document.history().doneCount(), steps + 1);
    EXPECT_FALSE(std::ranges::equal(top.points(), straight));
    StackCache cache;
    const auto shape = evaluateStack(top.document.groom(), cache);
    ASSERT_TRUE(shape);
    EXPECT_TRUE(
        std::ranges::equal(std::get<CowArray<Vec3f>>(*shape).view(), top.document.groom().positions()));
    ASSERT_TRUE(top.document.undo());
    EXPECT_TRUE(std::ranges::equal(top.points(), straight));
}

}  // namespace
}  // namespace hairloom::editing
