// SPDX-License-Identifier: GPL-3.0-or-later
// Heads that come in wrong, and the dialog that sets them right.
#include <QFile>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QToolButton>
#include <QTreeWidget>

#include "editor/dialogs/head_dialog.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class HeadTest : public WindowTest {
  protected:
    /// The dialog for that file, with the file read.
    HeadDialog* openDialog(const QString& path) {
        window->showHeadDialog(path);
        finishWork();
        auto* dialog = window->findChild<HeadDialog*>();
        EXPECT_TRUE(dialog);
        return dialog;
    }
    /// A fit that has been outdated is followed by another.
    void finishFitting() {
        while (parts().tasks.isBusy()) finishWork();
    }
    static QTreeWidget& groupsIn(HeadDialog& dialog) { return *dialog.findChild<QTreeWidget*>("headGroups"); }
    static QString textOf(HeadDialog& dialog, const char* label) {
        return dialog.findChild<QLabel*>(label)->text();
    }
    static void clickButton(HeadDialog& dialog, const char* button) {
        auto* found = dialog.findChild<QPushButton*>(button);
        ASSERT_TRUE(found && found->isEnabled()) << button;
        found->click();
    }
};

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
    auto* groups = &groupsIn(*dialog);
    ASSERT_EQ(groups->topLevelItemCount(), 2);
    dialog->findChild<QLineEdit*>("headSearch")->setText("HELP");
    EXPECT_TRUE(groups->topLevelItem(0)->isHidden());
    EXPECT_FALSE(groups->topLevelItem(1)->isHidden());
    EXPECT_EQ(groups->topLevelItem(1)->text(1), "Left out");
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

TEST_F(HeadTest, AGroupThatCollidesIsNotShownAndHasSpheresThatAFitLeaves) {
    files().openSample({});
    finishWork();
    const std::size_t all = groom().scalp->triangleCount();
    HeadDialog* dialog = openDialog(QString::fromStdString(groom().characterFile));
    QTreeWidget& groups = groupsIn(*dialog);
    ASSERT_EQ(groups.topLevelItemCount(), 5);
    EXPECT_FALSE(dialog->findChild<QPushButton*>("groupCollide")->isEnabled()) << "nothing is selected";
    for (const auto* button : dialog->findChildren<QPushButton*>())
        EXPECT_EQ(button->isDefault(), button->objectName() == "headOpen") << button->text().toStdString();
    EXPECT_FALSE(dialog->findChild<QSpinBox*>("colliderSpheres")->isEnabled());
    dialog->findChild<QLineEdit*>("headSearch")->setText("shoulders");
    groups.selectAll();
    clickButton(*dialog, "groupCollide");
    EXPECT_EQ(dialog->options().collideWith, std::vector<std::string>{"bust_shoulders"})
        << "what the search hides is not meant";
    dialog->findChild<QSpinBox*>("colliderSpheres")->setValue(7);
    finishFitting();
    EXPECT_TRUE(textOf(*dialog, "colliderFit").startsWith("7 spheres: worst gap"))
        << textOf(*dialog, "colliderFit").toStdString();
    dialog->accept();
    finishWork();
    EXPECT_LT(groom().scalp->triangleCount(), all);
    ASSERT_EQ(groom().spheres.size(), 7u);
    for (const CollisionSphere& sphere : groom().spheres) EXPECT_FALSE(sphere.bone.empty());
    EXPECT_FALSE(document().isModified());
    EXPECT_FALSE(window->actions().get("edit.undo").isEnabled());
    ASSERT_TRUE(parts().player.actor());
    EXPECT_EQ(parts().player.actor()->clips().size(), 1u);
    expectSound();

    const std::vector<CollisionSphere> clothes = groom().spheres;
    find<QSpinBox>("sphereCount")->setValue(4);
    for (int i = 0; i < 2; ++i) {
        find<QPushButton>("sphereFit")->click();
        finishWork();
        ASSERT_EQ(groom().spheres.size(), 11u);
        EXPECT_EQ(groom().spheres[6].centre, clothes[6].centre);
    }
    ASSERT_TRUE(window->saveTo(inFolder("dressed.hairloom")));
    trigger("file.new");
    window->open(inFolder("dressed.hairloom"));
    finishWork();
    EXPECT_EQ(groom().spheres.size(), 11u);
    ASSERT_TRUE(parts().player.actor());
    EXPECT_EQ(parts().player.actor()->mesh().triangleCount(), groom().scalp->triangleCount());
}

TEST_F(HeadTest, RolesAreChangedByKeysAndByClicks) {
    writeLyingHead(inFolder("lying.obj"));
    HeadDialog* dialog = openDialog(inFolder("lying.obj"));
    QTreeWidget& groups = groupsIn(*dialog);
    const auto roles = [&] {
        return groups.topLevelItem(0)->text(1) + ", " + groups.topLevelItem(1)->text(1);
    };
    EXPECT_EQ(roles(), "Head, Left out");
    groups.setFocus();
    QTest::keyClick(&groups, Qt::Key_Down);
    QTest::keyClick(&groups, Qt::Key_Space);
    finishFitting();
    EXPECT_EQ(roles(), "Head, Collides");
    EXPECT_TRUE(textOf(*dialog, "colliderFit").contains("12 spheres"))
        << textOf(*dialog, "colliderFit").toStdString();
    QTest::keyClick(&groups, Qt::Key_Space);
    EXPECT_EQ(roles(), "Head, Head");
    QTest::keyClick(&groups, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClick(&groups, Qt::Key_Space);
    QTest::keyClick(&groups, Qt::Key_Space);
    EXPECT_EQ(roles(), "Collides, Collides");
    finishFitting();
    EXPECT_FALSE(dialog->findChild<QPushButton*>("headOpen")->isEnabled());
    EXPECT_TRUE(textOf(*dialog, "headSize").contains("no head is left", Qt::CaseInsensitive))
        << textOf(*dialog, "headSize").toStdString();
    const QRect cell = groups.visualItemRect(groups.topLevelItem(0));
    QTest::mouseClick(groups.viewport(), Qt::LeftButton, {},
                      QPoint(groups.header()->sectionPosition(1) + 10, cell.center().y()));
    EXPECT_EQ(roles(), "Head, Collides");
    EXPECT_TRUE(dialog->findChild<QPushButton*>("headOpen")->isEnabled());
    // Closed while spheres are being fitted, which nothing waits for.
    dialog->reject();
    EXPECT_FALSE(parts().tasks.isBusy());
}

TEST_F(HeadTest, AHeadOpensWhileItsSpheresAreStillFitted) {
    writeLyingHead(inFolder("lying.obj"));
    HeadDialog* dialog = openDialog(inFolder("lying.obj"));
    groupsIn(*dialog).topLevelItem(1)->setSelected(true);
    clickButton(*dialog, "groupCollide");
    dialog->findChild<QSpinBox*>("colliderSpheres")->setValue(64);
    dialog->findChild<QSpinBox*>("colliderSpheres")->setValue(3);
    dialog->accept();
    finishWork();
    ASSERT_TRUE(groom().scalp) << window->statusLine().message().toStdString();
    EXPECT_EQ(groom().spheres.size(), 3u);
    EXPECT_TRUE(window->statusLine().message().contains("Spheres that hair will collide with: 3"))
        << window->statusLine().message().toStdString();
}

TEST_F(HeadTest, AHeadThatIsClearOpensAtOnce) {
    openBust();
    EXPECT_FALSE(window->findChild<HeadDialog*>());
    EXPECT_EQ(find<QLabel>("head")->text(), "head 42.9 cm");
}

}  // namespace
}  // namespace hairloom::editor
