// SPDX-License-Identifier: GPL-3.0-or-later
// The brush that paints where operators act.

#include <gmock/gmock.h>

#include "core/editing/mask_commands.h"
#include "core/editing/replay.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/groom/groom_hash.h"
#include "core/groom/mask_names.h"
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

TEST(MaskPaint, AMaskIsNamedInAStepThatScriptsHave) {
    TopStrand top;
    Document& document = top.document;
    const auto before = contentHash(document.groom());
    auto step = setMaskNames(document.model(), {"", "Fringe"});
    ASSERT_TRUE(step) << step.error().message();
    document.perform(std::move(*step));
    EXPECT_EQ(maskName(document.groom(), 2), "Fringe");
    EXPECT_TRUE(*setMaskNames(document.model(), {"", "Fringe"}) == nullptr) << "no step that changes nothing";
    EXPECT_FALSE(setMaskNames(document.model(), {"Fringe", "Fringe"}));
    const auto named = contentHash(document.groom());
    // Regions take the names of their colours, and one that another mask has leaves none.
    const std::vector<std::uint32_t> numbers{2, 3};
    const std::vector<std::vector<float>> values(2, std::vector<float>(document.groom().strandCount(), 1));
    const std::vector<std::string> called{"red", "red"};
    document.perform(fillMasks(document.model(), "Regions", numbers, values, called));
    EXPECT_THAT(document.groom().maskNames, testing::ElementsAre("", "red"));
    const auto filled = contentHash(document.groom());
    const auto script = document.script();
    ASSERT_TRUE(script) << script.error().message();
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(contentHash(document.groom()), named) << "fill and names are one step";
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(contentHash(document.groom()), before);
    Groom again = document.groom();
    const auto parsed = parseScript("s.json", *script, scriptExtensions());
    ASSERT_TRUE(parsed) << parsed.error().message();
    const auto report = runScript(*parsed, again);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(contentHash(again), filled);
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

/// Adds a curl that has this map.
void addCurl(Document& document, MaskMap map) {
    Operator curl = newOperator("curl");
    Mask mask;
    mask.map = map;
    setMaskOf(curl, mask);
    auto command = addOperator(document.model(), document.groom().operators.size(), curl);
    ASSERT_TRUE(command) << command.error().message();
    document.perform(std::move(*command));
}
void paint(Document& document, std::uint32_t number, float value) {
    document.perform(
        setMask(document.model(), number, std::vector<float>(document.groom().strandCount(), value)));
}

TEST(FreeMask, IsTheFirstThatNoOperatorHasAndNothingIsPaintedOn) {
    Document document(hairOnHead(20));
    EXPECT_EQ(freeMask(document.groom()), 1u);
    addCurl(document, MaskMap::mask1);
    EXPECT_EQ(freeMask(document.groom()), 2u);
    paint(document, 2, 0.5f);
    EXPECT_EQ(freeMask(document.groom()), 3u);
    paint(document, 3, 0);
    EXPECT_EQ(freeMask(document.groom()), 3u) << "what was painted was taken off again";
    addCurl(document, MaskMap::mask3);
    EXPECT_EQ(freeMask(document.groom()), 4u);
    addCurl(document, MaskMap::mask4);
    const auto none = freeMask(document.groom());
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), testing::HasSubstr("all 4 masks are in use"));
}

TEST(FillMask, TakesAFreeMaskInOneStepThatIsUndoneAndReplayed) {
    Document document(hairOnHead());
    addCurl(document, MaskMap::mask1);
    paint(document, 1, 1);
    addCurl(document, MaskMap::none);
    const std::uint64_t before = contentHash(document.groom());
    const std::size_t steps = document.history().doneCount();
    std::vector<float> values(document.groom().strandCount(), 0);
    for (std::size_t s = 0; s < values.size() / 2; ++s) values[s] = 1;
    auto filled = fillMaskOf(document.model(), 1, values);
    ASSERT_TRUE(filled) << filled.error().message();
    document.perform(std::move(*filled));
    EXPECT_EQ(document.history().doneCount(), steps + 1);
    EXPECT_EQ(maskOf(document.groom().operators[1]).map, MaskMap::mask2);
    EXPECT_TRUE(std::ranges::equal(document.groom().strandAttributes.view<float>("mask.2"), values));
    EXPECT_THAT(document.groom().strandAttributes.view<float>("mask.1"), testing::Each(1.0f));
    StackCache cache;
    const auto shape = evaluateStack(document.groom(), cache);
    ASSERT_TRUE(shape);
    EXPECT_TRUE(std::ranges::equal(std::get<CowArray<Vec3f>>(*shape).view(), document.groom().positions()));
    const std::uint64_t after = contentHash(document.groom());
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(contentHash(document.groom()), before);
    ASSERT_TRUE(document.redo());
    EXPECT_EQ(contentHash(document.groom()), after);
    expectScriptMakesTheSame(document);

    // Again: the operator has a map now, and takes no other.
    std::ranges::reverse(values);
    auto again = fillMaskOf(document.model(), 1, values);
    ASSERT_TRUE(again);
    document.perform(std::move(*again));
    EXPECT_EQ(maskOf(document.groom().operators[1]).map, MaskMap::mask2);
    EXPECT_TRUE(std::ranges::equal(document.groom().strandAttributes.view<float>("mask.2"), values));
    auto same = fillMaskOf(document.model(), 1, values);
    ASSERT_TRUE(same);
    EXPECT_EQ(*same, nullptr);
}

TEST(FillMask, RefusesWhereNoMaskIsFreeAndLeavesAllAsItWas) {
    Document document(hairOnHead(20));
    for (const std::uint32_t number : {1u, 2u, 3u, 4u}) paint(document, number, 0.25f);
    addCurl(document, MaskMap::density);
    const std::uint64_t before = contentHash(document.groom());
    const std::vector<float> values(document.groom().strandCount(), 1);
    const auto refused = fillMaskOf(document.model(), 0, values);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), testing::HasSubstr("all 4 masks are in use"));
    EXPECT_FALSE(fillMaskOf(document.model(), 1, values)) << "there is no such operator";
    EXPECT_EQ(contentHash(document.groom()), before);
}

}  // namespace
}  // namespace hairloom::editing
