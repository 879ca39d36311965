// SPDX-License-Identifier: GPL-3.0-or-later
// The stack of operators as people edit it: undo, drags, strokes on top, strands that come and go, scripts.
#include <gmock/gmock.h>

#include <algorithm>

#include "core/editing/place.h"
#include "core/editing/replay.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"
#include "tests/editing/editing_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::editing {
namespace {

using testing::HasSubstr;

/// With one setting at another value.
Operator operatorWith(std::string_view name, std::string_view field = {}, double value = 0) {
    nlohmann::json json{{"op", name}};
    if (!field.empty()) json[field] = value;
    JsonReader reader(json, "o.json");
    return readOperator(reader);
}

/// Hair that lies high enough for strokes over the top.
Operator highFlow() {
    const nlohmann::json json{{"op", "flow"}, {"gravity", 0.8}, {"liftRoot", 0.012}, {"liftTip", 0.006}};
    JsonReader reader(json, "o.json");
    return readOperator(reader);
}

void perform(Document& document, StackCommand command) {
    ASSERT_TRUE(command) << command.error().message();
    document.perform(std::move(*command));
}

void dragClump(Document& document, std::uint64_t key, double strength) {
    document.performMerged(key, [&](const Model& model) {
        auto made = setOperator(model, 1, operatorWith("clump", "strength", strength), "Clump strength");
        EXPECT_TRUE(made);
        return std::move(*made);
    });
}

/// The positions are what the operators make of the base shape, to the last bit.
void expectEvaluated(const Groom& groom) {
    StackCache cache;
    const auto shape = evaluateStack(groom, cache);
    ASSERT_TRUE(shape) << shape.error().message();
    EXPECT_TRUE(std::ranges::equal(std::get<CowArray<Vec3f>>(*shape).view(), groom.positions()));
    for (const Finding& finding : validate(groom))
        EXPECT_NE(finding.severity, Severity::Error) << finding.what;
}

/// Hair with flow, clump and noise.
struct StackEdit : testing::Test {
    StackEdit() {
        perform(document, addOperator(document.model(), 0, highFlow()));
        perform(document, addOperator(document.model(), 1, operatorWith("clump")));
        perform(document, addOperator(document.model(), 2, operatorWith("noise")));
    }
    const Groom& groom() const { return document.groom(); }
    std::uint64_t hash() const { return contentHash(groom()); }
    /// Undoes and does again every step, and looks whether each state is what it was.
    void expectHistoryHolds() {
        std::vector<std::uint64_t> states{hash()};
        while (document.undo()) states.push_back(hash());
        EXPECT_EQ(states.back(), contentHash(hairOnHead())) << "undone to the beginning";
        states.pop_back();
        while (document.redo()) {
            EXPECT_EQ(hash(), states.back());
            states.pop_back();
        }
        EXPECT_TRUE(states.empty());
        if (!groom().operators.empty()) expectEvaluated(groom());
    }

    Document document{hairOnHead()};
};

TEST(StackOfBaldHead, WaitsForHair) {
    Groom bald;
    bald.scalp = hairOnHead().scalp;
    bald.scalpSelection = hairOnHead().scalpSelection;
    for (const bool keepsBase : {true, false}) {
        Document document(bald);
        perform(document, addOperator(document.model(), 0, operatorWith("flow")));
        perform(document, addOperator(document.model(), 1, operatorWith("noise")));
        EXPECT_EQ(document.groom().operators.size(), 2u);
        Groom saved = document.groom();
        // As it came from a file of before.
        if (!keepsBase) saved.pointAttributes.erase(attribute::kBasePosition);
        Document opened(saved);
        perform(opened, moveOperator(opened.model(), 1, 0));
        ASSERT_TRUE(opened.replay(strokeFor("add")));
        EXPECT_GT(opened.groom().strandCount(), 5u);
        expectEvaluated(opened.groom());
        while (opened.undo()) {
        }
        EXPECT_EQ(contentHash(opened.groom()), contentHash(saved));
        while (document.undo()) {
        }
        EXPECT_EQ(contentHash(document.groom()), contentHash(bald));
    }
}

TEST_F(StackEdit, KeepsTheBaseShapeAndIsUndone) {
    const Groom before = hairOnHead();
    EXPECT_TRUE(std::ranges::equal(groom().pointAttributes.view<Vec3f>(attribute::kBasePosition),
                                   before.positions()));
    EXPECT_FALSE(std::ranges::equal(groom().positions(), before.positions()));
    expectEvaluated(groom());
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, EveryEditIsUndoneAndReplayed) {
    perform(document, moveOperator(document.model(), 2, 0));
    EXPECT_EQ(groom().operators[0].op, "noise");
    perform(document, copyOperator(document.model(), 1));
    EXPECT_EQ(groom().operators[2], groom().operators[1]);
    Operator muted = groom().operators[3];
    muted.enabled = false;
    perform(document, setOperator(document.model(), 3, muted, "Mute clump"));
    Operator half = groom().operators[0];
    half.weight = 0.5f;
    perform(document, setOperator(document.model(), 0, half, "Weight"));
    perform(document, removeOperator(document.model(), 1));
    expectEvaluated(groom());
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, RemovingAllGivesTheBaseShapeBack) {
    while (!groom().operators.empty()) perform(document, removeOperator(document.model(), 0));
    EXPECT_EQ(hash(), contentHash(hairOnHead()));
    expectHistoryHolds();
}

TEST_F(StackEdit, ADraggedSliderIsOneStepAndNoneWhenPutBack) {
    const std::size_t steps = document.history().doneCount();
    const std::uint64_t before = hash();
    for (const double strength : {0.2, 0.9, 0.4}) dragClump(document, 7, strength);
    EXPECT_EQ(document.history().doneCount(), steps + 1);
    expectEvaluated(groom());
    const std::uint64_t dragged = hash();
    document.undo();
    EXPECT_EQ(hash(), before);
    document.redo();
    EXPECT_EQ(hash(), dragged);
    document.undo();
    // Undone amid the drag: it goes on as a step of its own.
    for (const double strength : {0.3, 0.4}) dragClump(document, 7, strength);
    EXPECT_EQ(hash(), dragged);
    dragClump(document, 7, 0.6);  // as it was
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(document.history().doneCount(), steps);
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, StrokesGoToASculptOnTop) {
    const Groom before = groom();
    Groom combed = before;
    combed.operators.clear();
    combed.pointAttributes.erase(attribute::kBasePosition);
    Document without(combed);
    ASSERT_TRUE(without.replay(strokeOverTop("comb")));
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    ASSERT_EQ(groom().operators.size(), 4u);
    EXPECT_EQ(groom().operators[3].op, kSculpt);
    expectEvaluated(groom());
    float farthest = 0;
    for (std::size_t i = 0; i < groom().pointCount(); ++i) {
        farthest = std::max(farthest, (groom().positions()[i] - without.groom().positions()[i]).norm());
    }
    EXPECT_LT(farthest, 1e-6f) << "the shape is the one that was combed";
    ASSERT_TRUE(document.replay(strokeOverTop("puff", 0.02f)));
    EXPECT_EQ(groom().operators.size(), 4u) << "the sculpt that is there";
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, SculptFollowsWhatChangesBelowAndHasAWeight) {
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    const Groom combed = groom();
    dragClump(document, 9, 0.1);
    expectEvaluated(groom());
    std::size_t sculpted = 0;
    const auto shares = combed.pointAttributes.view<Vec3f>(sculptAttribute(1));
    for (std::size_t s = 0; s < combed.strandCount(); ++s) {
        // What hangs on a bend is carried along as it is: the bend alone is sculpted.
        const auto own = shares.subspan(combed.offsets[s], combed.offsets[s + 1] - combed.offsets[s]);
        sculpted += std::ranges::any_of(own, [](const Vec3f& share) { return !share.isZero(0); }) ? 1 : 0;
    }
    EXPECT_GE(sculpted, 5u);
    EXPECT_EQ(segmentLengths(groom()).size(), segmentLengths(combed).size());
    Operator sculpt = groom().operators[3];
    sculpt.enabled = false;
    perform(document, setOperator(document.model(), 3, sculpt, "Mute"));
    Groom without = groom();
    without.operators.pop_back();
    expectEvaluated(without);
    sculpt.enabled = true;
    sculpt.weight = 0.5f;
    perform(document, setOperator(document.model(), 3, sculpt, "Weight"));
    expectEvaluated(groom());
    ASSERT_TRUE(document.replay(strokeOverTop("comb", 0.03f)));
    EXPECT_EQ(groom().operators.size(), 5u) << "a sculpt of less weight is left alone";
    perform(document, copyOperator(document.model(), 3));
    EXPECT_NE(groom().operators[4].number, groom().operators[3].number);
    perform(document, removeOperator(document.model(), 3));
    EXPECT_FALSE(groom().pointAttributes.has(sculptAttribute(1)));
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, SoloLetsOneActAndThenAllAgain) {
    perform(document, soloOperator(document.model(), 1));
    for (std::size_t i = 0; i < groom().operators.size(); ++i)
        EXPECT_EQ(groom().operators[i].enabled, i == 1) << i;
    expectEvaluated(groom());
    perform(document, soloOperator(document.model(), 1));
    for (const Operator& one : groom().operators) EXPECT_TRUE(one.enabled);
    EXPECT_FALSE(soloOperator(document.model(), 99));
    std::vector<Operator> more{newOperator("wave"), newOperator(kSculpt)};
    perform(document, addOperators(document.model(), 1, more, "Add two"));
    EXPECT_EQ(groom().operators[1].op, "wave");
    EXPECT_EQ(groom().operators[2].op, kSculpt);
    EXPECT_NE(groom().operators[2].number, 0u);
    expectEvaluated(groom());
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, StrokesThatMoveNothingLeaveTheStackAlone) {
    for (const char* tool :
         {"freeze", "dye_paint", "mask_paint", "scalp_paint", "density_paint", "width_paint"}) {
        ASSERT_TRUE(document.replay(strokeFor(tool))) << tool;
        EXPECT_EQ(groom().operators.size(), 3u) << tool;
        expectEvaluated(groom());
    }
    ASSERT_TRUE(document.beginStroke(strokeOverTop("comb")));
    for (const Dab& dab : strokeOverTop("comb").dabs) ASSERT_TRUE(document.dab(dab));
    document.cancelStroke();
    expectEvaluated(groom());
    expectHistoryHolds();
}

TEST_F(StackEdit, StrandsComeAndGo) {
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    ASSERT_TRUE(document.replay(strokeFor("delete")));
    EXPECT_LT(groom().strandCount(), 300u);
    expectEvaluated(groom());
    const std::size_t left = groom().strandCount();
    ASSERT_TRUE(document.replay(strokeFor("add")));
    EXPECT_GT(groom().strandCount(), left);
    expectEvaluated(groom());
    document.perform(deleteStrands(document.model(), std::vector<std::uint32_t>{1, 5, 8}));
    expectEvaluated(groom());
    PlacementSettings placement = groom().placement;
    placement.count = 150;
    placement.points = 9;
    document.perform(setPlacementSettings(document.model(), placement));
    auto placed = place(groom(), {}, KeepOut{nullptr, 0});
    ASSERT_TRUE(placed) << placed.error().message();
    document.perform(std::move(*placed));
    EXPECT_GT(groom().strandCount(), 100u);
    expectEvaluated(groom());
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, AllStrandsGoAndNewOnesGrowStyled) {
    std::vector<std::uint32_t> all(groom().strandCount());
    for (std::uint32_t s = 0; s < all.size(); ++s) all[s] = s;
    document.perform(deleteStrands(document.model(), all));
    EXPECT_EQ(groom().strandCount(), 0u);
    expectEvaluated(groom());
    dragClump(document, 3, 0.2);
    auto placed = place(groom(), {}, KeepOut{nullptr, 0});
    ASSERT_TRUE(placed) << placed.error().message();
    document.perform(std::move(*placed));
    expectEvaluated(groom());
    EXPECT_FALSE(std::ranges::equal(groom().positions(),
                                    groom().pointAttributes.view<Vec3f>(attribute::kBasePosition)));
    expectHistoryHolds();
}

TEST_F(StackEdit, BakingKeepsTheShapeAndNothingElse) {
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    const std::vector<Vec3f> shape(groom().positions().begin(), groom().positions().end());
    perform(document, bakeOperators(document.model()));
    EXPECT_TRUE(std::ranges::equal(groom().positions(), shape));
    EXPECT_TRUE(groom().operators.empty());
    EXPECT_EQ(groom().pointAttributes.all().size(), hairOnHead().pointAttributes.all().size());
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    EXPECT_TRUE(groom().operators.empty()) << "strokes move the hair itself again";
    document.undo();
    document.undo();
    expectEvaluated(groom());
    document.redo();
    document.redo();
    expectScriptMakesTheSame(document);
}

TEST_F(StackEdit, AnotherDocumentHasItsOwnStack) {
    const Groom stacked = groom();
    Groom other = hairOnHead(40);
    document.perform(replaceGroom(document.model(), other, "Import"));
    EXPECT_TRUE(groom().operators.empty());
    EXPECT_EQ(hash(), contentHash(other));
    document.undo();
    EXPECT_EQ(hash(), contentHash(stacked));
    document.redo();
    document.perform(replaceGroom(document.model(), stacked, "Import"));
    EXPECT_EQ(hash(), contentHash(stacked));
    dragClump(document, 5, 0.9);
    expectEvaluated(groom());
}

TEST_F(StackEdit, SavedAndOpenedItGoesOn) {
    const TemporaryFolder folder;
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    ASSERT_TRUE(document.save(folder / "a.hairloom"));
    const auto opened = Document::open(folder / "a.hairloom");
    ASSERT_TRUE(opened) << opened.error().message();
    EXPECT_EQ(contentHash((*opened)->groom()), hash());
    for (Document* both : {&document, opened->get()}) dragClump(*both, 11, 0.3);
    EXPECT_EQ(contentHash((*opened)->groom()), hash());
}

TEST_F(StackEdit, WholeStackFromAList) {
    ASSERT_TRUE(document.replay(strokeOverTop("comb")));
    std::vector<Operator> list{groom().operators[3], operatorWith("curl"), operatorWith(kSculpt),
                               operatorWith(kSculpt)};
    perform(document, setOperators(document.model(), list, "Operators"));
    EXPECT_EQ(groom().operators[0].number, 1u) << "keeps its strokes";
    EXPECT_NE(groom().operators[2].number, groom().operators[3].number);
    expectEvaluated(groom());
    expectHistoryHolds();
    expectScriptMakesTheSame(document);
    const std::size_t steps = document.history().doneCount();
    perform(document, setOperators(document.model(), groom().operators, "Operators"));
    EXPECT_EQ(document.history().doneCount(), steps) << "the same list is no step";
}

TEST(StackErrors, NameThePlaceAndWhatToDo) {
    Document document(hairOnHead());
    EXPECT_THAT(removeOperator(document.model(), 0).error().message(),
                HasSubstr("operator 0 does not exist; there are 0 operators"));
    EXPECT_THAT(moveOperator(document.model(), 1, 0).error().message(),
                HasSubstr("operator 1 does not exist"));
    EXPECT_EQ(*bakeOperators(document.model()), nullptr);
    std::vector<Operator> many(kMaxOperators + 1, operatorWith("collide"));
    EXPECT_THAT(setOperators(document.model(), many, "Many").error().message(),
                HasSubstr("65 operators; expected at most 64"));
    Document bald(makeGroom({0, 3}, {Vec3f(0, 0, 0), Vec3f(0, 0.1f, 0), Vec3f(0, 0.2f, 0)}));
    EXPECT_THAT(addOperator(bald.model(), 0, operatorWith("flow")).error().message(),
                HasSubstr("the groom has no scalp"));
    EXPECT_TRUE(bald.groom().operators.empty());
    perform(bald, addOperator(bald.model(), 0, operatorWith("curl")));
    expectEvaluated(bald.groom());
}

/// A stack, then the operations of an older script.
Result<ScriptReport> runOnStack(Groom& groom, const std::string& operations) {
    const auto script = parseScript("s.json",
                                    R"({"hairloom_script": 1, "operations": [
        {"op": "add_operator", "at": 0, "operator": {"op": "curl"}}, )" +
                                        operations + "]}",
                                    scriptExtensions());
    if (!script) return tl::unexpected(script.error());
    return runScript(*script, groom);
}

TEST(StackScripts, OperationsJoinAStack) {
    Groom groom = hairOnHead();
    ASSERT_TRUE(runOnStack(groom, R"({"op": "dye"}, {"op": "noise", "amplitude": 0.003})"));
    ASSERT_EQ(groom.operators.size(), 2u);
    EXPECT_EQ(groom.operators[1].op, "noise");
    expectEvaluated(groom);
    // The same bits as without a stack.
    Groom plain = hairOnHead();
    const auto script = parseScript("s.json", R"({"hairloom_script": 1, "operations": [
        {"op": "curl"}, {"op": "noise", "amplitude": 0.003}]})",
                                    scriptExtensions());
    ASSERT_TRUE(script);
    ASSERT_TRUE(runScript(*script, plain));
    EXPECT_TRUE(plain.operators.empty());
    EXPECT_TRUE(std::ranges::equal(plain.positions(), groom.positions()));
}

TEST(StackScripts, OperationsAreRefusedWhereTheyWouldMoveWhatIsKept) {
    Groom groom = hairOnHead();
    groom.layers.resize(1);
    groom.layers[0].locked = true;
    const std::uint64_t before = contentHash(groom);
    const auto run = runOnStack(groom, R"({"op": "noise"})");
    ASSERT_FALSE(run);
    EXPECT_THAT(run.error().message(), HasSubstr("noise: frozen or locked strands"));
    EXPECT_EQ(contentHash(groom), before);
}

}  // namespace
}  // namespace hairloom::editing
