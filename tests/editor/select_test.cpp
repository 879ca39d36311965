// SPDX-License-Identifier: GPL-3.0-or-later
// What can be done with strands that are chosen, and hair that is placed anew where somebody paints.
#include <QComboBox>
#include <QMenu>
#include <algorithm>

#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "core/editing/stack_commands.h"
#include "editor/viewport/tool.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class SelectTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openHairFromTheFront();
    }
    std::size_t count(std::string_view flag) { return editing::strandsWithFlag(groom(), flag).size(); }
    /// The step that an action makes, undone and done again.
    void stepAndBack(const char* action) {
        const auto before = hash();
        const int steps = document().doneSteps();
        trigger(action);
        const auto after = hash();
        EXPECT_NE(after, before) << action;
        EXPECT_EQ(document().doneSteps(), steps + 1) << action;
        trigger("edit.undo");
        EXPECT_EQ(hash(), before) << action;
        trigger("edit.redo");
        EXPECT_EQ(hash(), after) << action;
        expectSound();
    }
    Vec3f frontRoot() {
        Vec3f front = groom().strand(0).front();
        for (std::size_t s = 1; s < groom().strandCount(); ++s) {
            if (groom().strand(s).front().z() > front.z()) front = groom().strand(s).front();
        }
        return front;
    }
};

TEST_F(SelectTest, FrameSelectionShowsWhatIsSelected) {
    const std::vector<std::uint32_t> few{3, 7, 8};
    document().perform(editing::selectStrands(document().editing().model(), few, editing::Choice::Replace));
    const float whole =
        viewport().camera().metresPerPixel(groom().strand(3).front(), viewport().viewSize_px());
    trigger("view.frameSelection");
    for (const std::uint32_t s : few) {
        for (const Vec3f& point : groom().strand(s)) {
            EXPECT_TRUE(viewport().rect().contains(at(point))) << "strand " << s;
        }
    }
    EXPECT_LT(viewport().camera().metresPerPixel(groom().strand(3).front(), viewport().viewSize_px()), whole)
        << "nearer than all of the head";
}

TEST_F(SelectTest, TheMenuSelectsHidesShowsFreezesAndDeletes) {
    const std::size_t all = groom().strandCount();
    trigger("select.hide");
    EXPECT_EQ(document().stepCount(), 0) << "nothing is selected";
    stepAndBack("select.all");
    EXPECT_EQ(count(attribute::kSelected), all);
    stepAndBack("select.none");
    EXPECT_EQ(count(attribute::kSelected), 0u);
    const std::vector<std::uint32_t> few{3, 7, 8, 100};
    document().perform(editing::selectStrands(document().editing().model(), few, editing::Choice::Replace));
    stepAndBack("select.invert");
    EXPECT_EQ(count(attribute::kSelected), all - few.size());
    stepAndBack("select.invert");
    stepAndBack("select.hide");
    EXPECT_EQ(count(attribute::kHidden), few.size());
    stepAndBack("select.show");
    EXPECT_EQ(count(attribute::kHidden), 0u);
    stepAndBack("select.hideOthers");
    EXPECT_EQ(count(attribute::kHidden), all - few.size());
    stepAndBack("select.show");
    stepAndBack("select.freeze");
    EXPECT_EQ(count(attribute::kFrozen), few.size());
    stepAndBack("select.thaw");
    stepAndBack("select.delete");
    EXPECT_EQ(groom().strandCount(), all - few.size());
}

TEST_F(SelectTest, GroupsOfTheFileAreSelected) {
    Groom grouped = groom();
    grouped.groupNames = {"fringe", "back"};
    std::vector<std::uint32_t> groups(grouped.strandCount(), 1);
    std::fill_n(groups.begin(), 25, 0);
    grouped.strandAttributes.set(attribute::kGroup, groups);
    document().open(std::move(grouped), {}, "grouped");
    QMenu* menu = nullptr;
    for (QMenu* candidate : window->findChildren<QMenu*>()) {
        if (candidate->title() == "By &group") menu = candidate;
    }
    ASSERT_TRUE(menu);
    Q_EMIT menu->aboutToShow();
    ASSERT_EQ(menu->actions().size(), 2);
    menu->actions().front()->trigger();
    EXPECT_EQ(count(attribute::kSelected), 25u);
}

TEST_F(SelectTest, StrandsAreSelectedByBoxRootTipAndClick) {
    trigger("tool.select");
    const auto choose = [this](const char* control, int index) {
        auto* box = find<QComboBox>(control);
        box->setCurrentIndex(index);
        Q_EMIT box->activated(index);
    };
    const QPoint middle = at(frontRoot());
    const auto dragBox = [&] { drag({middle + QPoint(-25, -25), middle, middle + QPoint(25, 25)}); };
    choose("selectShape", 0);
    choose("selectPart", 0);
    dragBox();
    const std::size_t any = count(attribute::kSelected);
    choose("selectPart", 1);
    dragBox();
    const std::size_t roots = count(attribute::kSelected);
    const auto withRoots = editing::strandsWithFlag(groom(), attribute::kSelected);
    choose("selectPart", 2);
    dragBox();
    const std::size_t tips = count(attribute::kSelected);
    EXPECT_GT(any, 0u);
    EXPECT_GT(roots, 0u);
    EXPECT_LE(roots, any);
    EXPECT_LE(tips, any);
    EXPECT_NE(editing::strandsWithFlag(groom(), attribute::kSelected), withRoots);
    choose("selectPart", 0);
    press(middle);
    release(middle);
    EXPECT_EQ(count(attribute::kSelected), 1u) << "a click takes one strand";
    // Shift adds, Ctrl takes away.
    drag({middle + QPoint(-25, -25), middle, middle + QPoint(25, 25)}, Qt::ShiftModifier);
    EXPECT_GE(count(attribute::kSelected), any);
    drag({middle + QPoint(-25, -25), middle, middle + QPoint(25, 25)}, Qt::ControlModifier);
    EXPECT_LT(count(attribute::kSelected), any);
}

TEST_F(SelectTest, HairIsPlacedAnewOnlyWhereItIsPainted) {
    trigger("tool.replace");
    // Operators act on all hair, and clumps find other centres where roots come.
    document().perform(std::move(*editing::bakeOperators(document().editing().model())));
    const Groom before = groom();
    const auto hashBefore = hash();
    const QPoint here = at(frontRoot());
    drag({here, here + QPoint(8, -4), here + QPoint(16, -8)});
    EXPECT_EQ(document().stepCount(), 2) << window->statusLine().message().toStdString();
    const auto after = hash();
    EXPECT_NE(after, hashBefore);
    expectSound();
    // Strands that stayed kept their ids and every bit of their points.
    const auto idsBefore = before.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    const auto ids = groom().strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::size_t same = 0;
    for (std::size_t s = 0; s < ids.size(); ++s) {
        const auto old = std::ranges::find(idsBefore, ids[s]);
        if (old == idsBefore.end()) continue;
        ++same;
        EXPECT_TRUE(std::ranges::equal(groom().strand(s),
                                       before.strand(static_cast<std::size_t>(old - idsBefore.begin()))));
    }
    EXPECT_GT(same, before.strandCount() / 2);
    EXPECT_LT(same, before.strandCount());
    trigger("edit.undo");
    EXPECT_EQ(hash(), hashBefore);
    trigger("edit.redo");
    EXPECT_EQ(hash(), after);
    trigger("edit.undo");
    press(here);
    moveTo(here + QPoint(10, 0));
    key(Qt::Key_Escape);
    release(here + QPoint(10, 0));
    EXPECT_EQ(hash(), hashBefore) << "Esc leaves nothing";
}

}  // namespace
}  // namespace hairloom::editor
