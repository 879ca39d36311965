// SPDX-License-Identifier: GPL-3.0-or-later
// Heads that come in wrong, and the dialog that sets them right.
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QToolButton>

#include "editor/dialogs/head_dialog.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class HeadTest : public WindowTest {};

/// A box of skin of 17 × 4 × 3 units that lies along Z, and a helper far away.
void writeLyingHead(const QString& path) {
    QFile file(path);
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    const auto box = [&](const char* group, const std::array<double, 3>& low,
                         const std::array<double, 3>& high, int first) {
        QByteArray text = QByteArray("g ") + group + "\n";
        for (int corner = 0; corner < 8; ++corner) {
            text += "v";
            for (std::size_t axis = 0; axis < 3; ++axis)
                text += " " + QByteArray::number(((corner >> axis) & 1) != 0 ? high[axis] : low[axis]);
            text += "\n";
        }
        for (const auto& face : std::vector<std::array<int, 4>>{
                 {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
            text += "f";
            for (const int corner : face) text += " " + QByteArray::number(first + corner);
            text += "\n";
        }
        file.write(text);
    };
    box("skin", {-2, -1.5, 0}, {2, 1.5, 17}, 1);
    box("helper-skirt", {-200, -3, 0}, {-190, 3, 5}, 9);
}

TEST_F(HeadTest, AHeadThatLooksWrongIsShownWithItsUnitAxisAndGroupsGuessed) {
    writeLyingHead(inFolder("lying.obj"));
    window->open(inFolder("lying.obj"));
    finishWork();
    auto* dialog = window->findChild<HeadDialog*>();
    ASSERT_TRUE(dialog) << "it is no head as it is";
    finishWork();
    EXPECT_TRUE(dialog->findChild<QToolButton*>("headUnit:dm")->isChecked());
    EXPECT_TRUE(dialog->findChild<QToolButton*>("headUp:Z")->isChecked());
    EXPECT_EQ(dialog->options().leaveOut, std::vector<std::string>{"helper-skirt"});
    EXPECT_TRUE(dialog->findChild<QLabel*>("headSize")->text().contains("170 cm"))
        << dialog->findChild<QLabel*>("headSize")->text().toStdString();
    QTest::mouseClick(dialog->findChild<QToolButton*>("headUp:Y"), Qt::LeftButton);
    EXPECT_TRUE(dialog->findChild<QLabel*>("headSize")->text().contains("<b>30 cm</b>"));
    QTest::mouseClick(dialog->findChild<QToolButton*>("headUp:Z"), Qt::LeftButton);
    auto* groups = dialog->findChild<QListWidget*>("headGroups");
    ASSERT_EQ(groups->count(), 2);
    dialog->findChild<QLineEdit*>("headSearch")->setText("HELP");
    EXPECT_TRUE(groups->item(0)->isHidden());
    EXPECT_FALSE(groups->item(1)->isHidden());
    dialog->accept();
    finishWork();
    ASSERT_TRUE(groom().scalp);
    const Vec3f size = groom().scalp->bounds().sizes();
    EXPECT_NEAR(size.x(), 0.4f, 1e-5f);
    EXPECT_NEAR(size.y(), 1.7f, 1e-5f);
    EXPECT_NEAR(size.z(), 0.3f, 1e-5f);
    EXPECT_EQ(groom().scalp->groupNames(), std::vector<std::string>{"skin"});
    EXPECT_EQ(find<QLabel>("head")->text(), "head 170 cm");
    EXPECT_TRUE(find<QLabel>("head")->toolTip().contains("dm"));
    ASSERT_TRUE(window->saveTo(inFolder("lying.hairloom")));
    trigger("file.new");
    EXPECT_FALSE(find<QLabel>("head")->isVisible());
    window->open(inFolder("lying.hairloom"));
    finishWork();
    EXPECT_EQ(find<QLabel>("head")->text(), "head 170 cm");
}

TEST_F(HeadTest, AHeadThatIsClearOpensAtOnce) {
    openBust();
    EXPECT_FALSE(window->findChild<HeadDialog*>());
    EXPECT_EQ(find<QLabel>("head")->text(), "head 42.9 cm");
}

}  // namespace
}  // namespace hairloom::editor
