// SPDX-License-Identifier: GPL-3.0-or-later
// The Poses panel as an animator uses it: a pose made, followed, masked, keyed, renamed, undone, and played.
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QTreeWidget>

#include "core/groom/poses.h"
#include "editor/fields/number_box.h"
#include "editor/fields/ramp_edit.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class PosesTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        window->panel("poses")->show();
        window->panel("poses")->raise();
        QCoreApplication::processEvents();
    }
    QTreeWidget& list() { return *find<QTreeWidget>("poses"); }
    void click(const char* button) { find<QPushButton>(button)->click(); }
    void set(const char* field, double value) { find<NumberBox>(field)->spinBox().setValue(value); }
    /// Hair that is not where the pose will be.
    void lean() {
        Groom leaning = groom();
        for (Vec3f& point : leaning.pointAttributes.edit<Vec3f>(attribute::kPosition))
            point.x() += 0.4f * (point.y() - 1.6f);
        change("Lean", leaning);
    }
};

TEST_F(PosesTest, AShapeBecomesAPoseAndIsUndone) {
    EXPECT_FALSE(find<QPushButton>("poseRemove")->isEnabled());
    const auto before = hash();
    lean();
    click("poseAdd");
    ASSERT_EQ(list().topLevelItemCount(), 1);
    EXPECT_EQ(list().topLevelItem(0)->text(0), "Pose 1");
    ASSERT_EQ(groom().poses.size(), 1u);
    set("poseAmount", 0.5);
    EXPECT_EQ(groom().poses[0].amount, 0.5f);
    EXPECT_EQ(list().topLevelItem(0)->text(1), "0.5");
    set("poseMask", 2);
    EXPECT_EQ(groom().poses[0].mask, 2u);
    list().topLevelItem(0)->setText(0, "Windswept");
    EXPECT_EQ(groom().poses[0].name, "Windswept");
    EXPECT_TRUE(groom().pointAttributes.has(poseAttribute("Windswept")));
    list().topLevelItem(0)->setText(0, "a/b");
    EXPECT_EQ(list().topLevelItem(0)->text(0), "Windswept") << "that is no name";
    click("poseRemove");
    EXPECT_EQ(list().topLevelItemCount(), 0);
    trigger("edit.undo");
    EXPECT_EQ(list().topLevelItemCount(), 1);
    expectSound();
    while (document().editing().canUndo()) trigger("edit.undo");
    EXPECT_EQ(hash(), before);
}

TEST_F(PosesTest, HairThatPlaysFollowsTheAmount) {
    click("poseAdd");
    click("poseSwap");
    lean();
    click("poseSwap");
    const auto shape = groom().pointAttributes.view<Vec3f>(poseAttribute("Pose 1"));
    const std::vector<Vec3f> pose(shape.begin(), shape.end());
    set("poseAmount", 1);
    trigger("play.toggle");
    const auto away = [&] {
        const auto& frame = parts().player.frame();
        if (!frame || frame->pose->positions_ws.size() != pose.size()) return 1.0f;
        double sum = 0;
        for (std::size_t p = 0; p < pose.size(); ++p)
            sum += static_cast<double>((frame->pose->positions_ws[p] - pose[p]).norm());
        return static_cast<float>(sum / static_cast<double>(pose.size()));
    };
    // Lengths are the hair's own, so tips stay off the pose's.
    EXPECT_TRUE(QTest::qWaitFor([&] { return away() < 0.006f; }, 60'000)) << away();
    set("poseAmount", 0);
    EXPECT_TRUE(QTest::qWaitFor([&] { return away() > 0.012f; }, 60'000)) << away();
    trigger("play.toggle");
}

}  // namespace
}  // namespace hairloom::editor
