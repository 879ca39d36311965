// SPDX-License-Identifier: GPL-3.0-or-later
// The Poses panel as an animator uses it: a pose made, followed, masked, keyed, renamed, undone, and played.
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QTreeWidget>

#include "core/editing/settings_commands.h"
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
        dropOperators(leaning);
        for (std::size_t s = 0; s < leaning.strandCount(); ++s) {
            const Vec3f root = leaning.strand(s)[0];
            auto& positions = leaning.pointAttributes.edit<Vec3f>(attribute::kPosition);
            for (std::uint32_t p = leaning.offsets[s]; p < leaning.offsets[s + 1]; ++p)
                positions[p] = root + Eigen::AngleAxisf(0.6f, Vec3f::UnitY()) * Vec3f(positions[p] - root);
        }
        document().perform(editing::replaceGroom(document().editing().model(), std::move(leaning), "Lean"));
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
    lean();
    click("poseSwap");
    const auto shape = groom().pointAttributes.view<Vec3f>(poseAttribute("Pose 1"));
    const std::vector<Vec3f> pose(shape.begin(), shape.end());
    const auto mean = [&](std::span<const Vec3f> positions) {
        double sum = 0;
        for (std::size_t p = 0; p < pose.size(); ++p)
            sum += static_cast<double>((positions[p] - pose[p]).norm());
        return static_cast<float>(sum / static_cast<double>(pose.size()));
    };
    const float apart = mean(groom().positions());
    ASSERT_GT(apart, 2e-3f) << "the pose is another shape";
    set("poseAmount", 1);
    trigger("play.toggle");
    const auto away = [&] {
        const auto& frame = parts().player.frame();
        if (!frame || frame->pose->positions_ws.size() != pose.size()) return 1.0f;
        return mean(frame->pose->positions_ws);
    };
    // The head holds off some of the hair that the pose leads into it.
    EXPECT_TRUE(QTest::qWaitFor([&] { return away() < 0.4f * apart; }, kPatience))
        << away() << " of " << apart;
    set("poseAmount", 0);
    EXPECT_TRUE(QTest::qWaitFor([&] { return away() > 0.8f * apart; }, kPatience))
        << away() << " of " << apart;
    trigger("play.toggle");
}

}  // namespace
}  // namespace hairloom::editor
