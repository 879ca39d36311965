// SPDX-License-Identifier: GPL-3.0-or-later
// The Levels panel as a new user walks it: make, look, change the strands, make anew, export.
#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QScrollBar>
#include <QTreeWidget>
#include <algorithm>
#include <map>
#include <set>

#include "core/documents/hair_import.h"
#include "core/editing/selection_commands.h"
#include "core/operations/script.h"
#include "editor/panels/accuracy_plot.h"
#include "editor/panels/levels_panel.h"
#include "editor/style/theme.h"
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
    QString failsOf(int row) { return table().topLevelItem(row)->data(0, Qt::UserRole).toString(); }
    LevelView& view() { return *find<LevelView>("levelView"); }
    void make() {
        find<QPushButton>("levelsMake")->click();
        ASSERT_TRUE(parts().tasks.isBusy());
        finishWork();
    }
    CardTool& tool() { return dynamic_cast<CardTool&>(*parts().tools.find("card")); }
    QString cardWords() { return find<QLabel>("cardWords")->text(); }
    double width() { return find<NumberBox>("cardWidth")->value(); }
    /// Picks card after card in the view until one is as it is wanted; false where none is.
    bool pick(const std::function<bool()>& isWanted) {
        find<QPushButton>("cardPick")->click();
        EXPECT_EQ(parts().tools.active(), &tool());
        viewport().look(render::View::Front);
        viewport().frameAll();
        for (int y = 0; y < viewport().height(); y += 12) {
            for (int x = 0; x < viewport().width(); x += 12) {
                if (!tool().cardAt(QPoint(x, y))) continue;
                press({x, y});
                release({x, y});
                if (isWanted()) return true;
            }
        }
        return false;
    }
    /// The chart has every level but all strands at the distances of all, and a click on a point chooses it.
    void expectEqualDistances() {
        auto& plot = *find<AccuracyPlot>("levelsPlot");
        std::map<std::size_t, std::set<double>> distances;
        for (const AccuracyPoint& point : plot.points()) distances[point.line].insert(point.milliseconds);
        ASSERT_EQ(distances.size(), 5u);
        const std::set<double>& all = distances.begin()->second;
        EXPECT_GE(all.size(), 4u);
        for (const auto& [level, metres] : distances) {
            const std::set<double> further(all.lower_bound(*metres.begin()), all.end());
            EXPECT_EQ(metres, further) << level << ": from where it starts on, as the others";
        }
        table().setCurrentItem(table().topLevelItem(0));
        const std::size_t last = plot.points().size() - 1;
        QTest::mouseClick(&plot, Qt::LeftButton, {}, plot.place_px(last).toPoint());
        EXPECT_GT(table().indexOfTopLevelItem(table().currentItem()), 0);
        EXPECT_FALSE(table().horizontalScrollBar()->isVisible());
        EXPECT_LE(table().header()->length(), table().viewport()->width()) << "no column is cut";
        table().setCurrentItem(table().topLevelItem(2));
    }
    bool isPicked() { return find<QPushButton>("cardDelete")->isEnabled(); }
    void changeColour() {
        Groom changed = groom();
        changed.material.specular += 0.1f;
        change("Specular", changed);
    }
    /// Deletes one in three of the strands that no card shaped by hand stands for, and drapes the others.
    void changeStrands() {
        std::vector<std::uint32_t> gone;
        for (std::uint32_t s = 0; s < groom().strandCount(); s += 3) {
            const bool isHeld = std::ranges::any_of(groom().cardEdits, [&](const CardEdit& edit) {
                return std::ranges::find(edit.roots, groom().strand(s)[0]) != edit.roots.end();
            });
            if (!isHeld) gone.push_back(s);
        }
        document().perform(editing::deleteStrands(document().editing().model(), gone));
        const std::string drape = R"({"op": "drape"})";
        const auto script =
            parseDocumentScript("drape", R"({"hairloom_script": 1, "operations": [)" + drape + "]}");
        ASSERT_TRUE(script) << script.error().message();
        Groom draped = groom();
        const auto touched = runScript(*script, draped);
        ASSERT_TRUE(touched && touched->touchedStrands > 0);
        document().perform(
            editing::replaceGroom(document().editing().model(), std::move(draped), "Drape", drape));
    }
};

TEST_F(LevelsTest, AChainIsMadeLookedAtMadeAnewAndExported) {
    EXPECT_TRUE(words().contains("Replacements for this hair"));
    EXPECT_FALSE(table().isVisibleTo(window.get()));
    EXPECT_FALSE(find<QPushButton>("levelsExport")->isEnabled());
    const auto before = hash();
    make();
    EXPECT_EQ(hash(), before) << "making changes nothing";
    ASSERT_TRUE(table().isVisibleTo(window.get())) << window->statusLine().message().toStdString();
    ASSERT_EQ(table().topLevelItemCount(), 6);
    EXPECT_EQ(cell(0, 0), "strands-100");
    EXPECT_EQ(cell(0, 3), "0.000");
    EXPECT_EQ(cell(2, 0), "cards-24");
    expectEqualDistances();
    EXPECT_EQ(cell(2, 2), "5.80") << "from where the budget says";
    EXPECT_GT(cell(2, 3).toDouble(), 0);
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
    EXPECT_FALSE(words().contains("hair has changed"));
    changeColour();
    EXPECT_TRUE(words().contains("hair has changed")) << words().toStdString();
    make();
    EXPECT_FALSE(words().contains("hair has changed")) << words().toStdString();
    EXPECT_EQ(cell(5, 0), "shell-800");
    find<LevelsPanel>("levels")->exportTo(inFolder("few.glb"));
    QFile file(inFolder("few.glb"));
    ASSERT_TRUE(file.open(QFile::ReadOnly));
    EXPECT_EQ(file.read(4), "glTF");
    EXPECT_TRUE(window->statusLine().message().contains("4 levels"))
        << window->statusLine().message().toStdString();
}

TEST_F(LevelsTest, WhatFailsAMeasureIsRedAndSaysWhich) {
    openSampleHair("short");
    Groom few = firstStrands(groom(), 300);
    few.scalp = groom().scalp;
    document().open(std::move(few), {}, "few on the head");
    find<NumberBox>("levelCards")->spinBox().setValue(4);
    find<NumberBox>("levelDistance")->spinBox().setValue(1.5);
    make();
    ASSERT_GT(table().topLevelItemCount(), 2) << window->statusLine().message().toStdString();
    const QColor red = themeColours(parts().preferences.theme()).bad;
    EXPECT_EQ(failsOf(0), "") << "strands beside themselves";
    int failed = 0;
    for (int row = 0; row < table().topLevelItemCount(); ++row) {
        const QTreeWidgetItem& item = *table().topLevelItem(row);
        const bool fails = !failsOf(row).isEmpty();
        failed += fails ? 1 : 0;
        EXPECT_EQ(item.foreground(0).color() == red, fails) << row;
        EXPECT_TRUE(item.toolTip(0).contains(failsOf(row).section(',', 0, 0))) << row;
        table().setCurrentItem(table().topLevelItem(row));
        const QString detail = find<QLabel>("levelsDetail")->text();
        EXPECT_TRUE(detail.startsWith(item.text(0))) << detail.toStdString();
        EXPECT_EQ(detail.contains("Fails"), fails) << detail.toStdString();
    }
    EXPECT_GT(failed, 0) << "4 cards before the skin";
}

TEST_F(LevelsTest, ACardShapedByHandStaysSoWhenTheRestIsMadeAnew) {
    make();
    const auto before = hash();
    EXPECT_FALSE(isPicked());
    ASSERT_TRUE(pick([this] { return isPicked(); }));
    EXPECT_TRUE(find<QCheckBox>("levelOver")->isChecked()) << "who picks wants to see";
    EXPECT_TRUE(cardWords().startsWith("Card ")) << cardWords().toStdString();
    EXPECT_EQ(hash(), before) << "picking changes nothing";
    find<NumberBox>("cardWidth")->spinBox().setValue(2);
    find<NumberBox>("cardBend")->spinBox().setValue(-0.5);
    find<QPushButton>("cardPin")->click();
    ASSERT_EQ(groom().cardEdits.size(), 1u);
    const CardEdit shaped = groom().cardEdits[0];
    EXPECT_EQ(shaped.level, 24u);
    EXPECT_FLOAT_EQ(shaped.width, 2);
    EXPECT_FLOAT_EQ(shaped.bend, -0.5f);
    EXPECT_EQ(shaped.strip.size(), kCardStations);
    EXPECT_EQ(document().stepCount(), 3);
    EXPECT_TRUE(words().contains("hair has changed")) << words().toStdString();
    // The strands change, the level is made anew: the card is there as it was shaped.
    changeStrands();
    ASSERT_EQ(groom().cardEdits.size(), 1u);
    make();
    EXPECT_FALSE(words().contains("hair has changed"));
    EXPECT_FALSE(words().contains("lost")) << words().toStdString();
    ASSERT_TRUE(pick([this] { return width() == 2; }));
    EXPECT_EQ(find<NumberBox>("cardBend")->value(), -0.5);
    EXPECT_TRUE(find<QPushButton>("cardPin")->isChecked());
    EXPECT_TRUE(cardWords().contains(QString("of %1 hairs").arg(shaped.roots.size())))
        << cardWords().toStdString();
    // Another is deleted, by the key, and comes back.
    ASSERT_TRUE(pick([this] { return width() == 1; }));
    key(Qt::Key_Delete);
    ASSERT_EQ(groom().cardEdits.size(), 2u);
    EXPECT_TRUE(groom().cardEdits[1].deleted);
    EXPECT_FALSE(isPicked()) << "what is deleted is picked no more";
    trigger("edit.undo");
    EXPECT_EQ(groom().cardEdits.size(), 1u);
    find<LevelsPanel>("levels")->exportTo(inFolder("few.glb"));
    EXPECT_TRUE(window->statusLine().message().contains("Exported few.glb"))
        << window->statusLine().message().toStdString();
    // With other budgets the card is of a level that is not made.
    find<NumberBox>("levelCards")->spinBox().setValue(20);
    make();
    EXPECT_TRUE(words().contains("1 edited cards are of levels that were not created"))
        << words().toStdString();
    EXPECT_FALSE(pick([this] { return width() == 2; }));
    // Scripts and projects have it.
    const auto script = document().editing().script();
    ASSERT_TRUE(script) << script.error().message();
    EXPECT_NE(script->find("card_edits"), std::string::npos);
    ASSERT_TRUE(window->saveTo(inFolder("few.hairloom")));
    find<NumberBox>("levelCards")->spinBox().setValue(24);
    make();
    find<QPushButton>("cardForgetAll")->click();
    EXPECT_TRUE(groom().cardEdits.empty());
    files().open(inFolder("few.hairloom"));
    finishWork();
    ASSERT_EQ(groom().cardEdits.size(), 1u);
    EXPECT_EQ(groom().cardEdits[0].roots, shaped.roots);
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
    EXPECT_TRUE(words().contains("hair has changed"));
    openBust();
    EXPECT_FALSE(table().isVisibleTo(window.get()));
    EXPECT_TRUE(words().contains("Place hair"));
    EXPECT_FALSE(find<QPushButton>("levelsMake")->isEnabled());
}

}  // namespace
}  // namespace hairloom::editor
