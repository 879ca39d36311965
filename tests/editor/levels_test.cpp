// SPDX-License-Identifier: GPL-3.0-or-later
// The Levels panel as a new user walks it: make, look, change the strands, make anew, export.
#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>

#include "editor/panels/levels_panel.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class LevelsTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        // Few strands and no head: a chain that is made in seconds.
        openFirstStrands(300);
        window->panel("levels")->raise();
        QCoreApplication::processEvents();
        find<NumberBox>("levelCards")->spinBox().setValue(24);
        find<NumberBox>("levelTextures")->spinBox().setValue(8);
        find<NumberBox>("levelDistance")->spinBox().setValue(5.8);
    }
    QString words() { return find<QLabel>("levelsWords")->text(); }
    QTreeWidget& table() { return *find<QTreeWidget>("levelsTable"); }
    QString cell(int row, int column) { return table().topLevelItem(row)->text(column); }
    LevelView& view() { return *find<LevelView>("levelView"); }
    void make() {
        find<QPushButton>("levelsMake")->click();
        ASSERT_TRUE(parts().tasks.isBusy());
        finishWork();
    }
    void changeColour() {
        Groom changed = groom();
        changed.material.specular += 0.1f;
        change("Specular", changed);
    }
};

TEST_F(LevelsTest, AChainIsMadeLookedAtMadeAnewAndExported) {
    EXPECT_TRUE(words().contains("stands for this hair"));
    EXPECT_FALSE(table().isVisibleTo(window.get()));
    EXPECT_FALSE(find<QPushButton>("levelsExport")->isEnabled());
    const auto before = hash();
    make();
    EXPECT_EQ(hash(), before) << "making changes nothing";
    ASSERT_TRUE(table().isVisibleTo(window.get())) << window->statusLine().message().toStdString();
    ASSERT_EQ(table().topLevelItemCount(), 6);
    EXPECT_EQ(cell(0, 0), "strands-100");
    EXPECT_EQ(cell(0, 7), "0.000");
    EXPECT_EQ(cell(2, 0), "cards-24");
    EXPECT_EQ(cell(2, 4), "5.80") << "from where the budget says";
    EXPECT_GT(cell(2, 7).toDouble(), 0);
    // The nearest cards are shown first; their textures and the sides they are seen from can be leafed
    // through.
    EXPECT_EQ(table().indexOfTopLevelItem(table().currentItem()), 2);
    EXPECT_EQ(find<QComboBox>("levelMap")->count(), 4);
    EXPECT_FALSE(find<QLabel>("levelTexture")->pixmap().isNull());
    const QImage front = view().grab().toImage();
    find<NumberBox>("levelDirection")->spinBox().setValue(3);
    EXPECT_NE(view().grab().toImage(), front);
    // Left of the line are strands: at the far left of it there is the level alone.
    const QRectF at = view().picture_px();
    QTest::mouseClick(&view(), Qt::LeftButton, {}, at.topLeft().toPoint());
    EXPECT_LT(view().split(), 0.02f);
    const QImage level = view().grab().toImage();
    QTest::mouseClick(&view(), Qt::LeftButton, {}, (at.bottomRight() - QPointF(1, 2)).toPoint());
    EXPECT_GT(view().split(), 0.98f);
    EXPECT_NE(view().grab().toImage(), level);
    // A shell has no texture.
    table().setCurrentItem(table().topLevelItem(5));
    EXPECT_EQ(find<QComboBox>("levelMap")->count(), 0);
    // The strands change: the panel says so until the chain is made anew.
    EXPECT_FALSE(words().contains("changed since"));
    changeColour();
    EXPECT_TRUE(words().contains("changed since")) << words().toStdString();
    make();
    EXPECT_FALSE(words().contains("changed since")) << words().toStdString();
    EXPECT_EQ(cell(5, 0), "shell-800");
    find<LevelsPanel>("levels")->exportTo(inFolder("few.glb"));
    QFile file(inFolder("few.glb"));
    ASSERT_TRUE(file.open(QFile::ReadOnly));
    EXPECT_EQ(file.read(4), "glTF");
    EXPECT_TRUE(window->statusLine().message().contains("4 levels"))
        << window->statusLine().message().toStdString();
}

TEST_F(LevelsTest, StoppedWorkAndAnotherDocumentLeaveNothing) {
    find<QPushButton>("levelsMake")->click();
    parts().tasks.cancel();
    finishWork();
    EXPECT_FALSE(table().isVisibleTo(window.get()));
    make();
    find<QPushButton>("levelsMake")->click();
    changeColour();
    parts().tasks.cancel();
    finishWork();
    EXPECT_TRUE(table().isVisibleTo(window.get())) << "what was made stays";
    EXPECT_TRUE(words().contains("changed since"));
    openBust();
    EXPECT_FALSE(table().isVisibleTo(window.get()));
    EXPECT_TRUE(words().contains("Place hair"));
    EXPECT_FALSE(find<QPushButton>("levelsMake")->isEnabled());
}

}  // namespace
}  // namespace hairloom::editor
