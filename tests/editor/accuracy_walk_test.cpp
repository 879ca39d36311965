// SPDX-License-Identifier: GPL-3.0-or-later
// What accuracy costs, as somebody finds it who has never seen the panels: by the words on the screen and the
// mouse. Its screens stay as files.
#include <QDir>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QTabBar>
#include <QToolTip>
#include <QTreeWidget>

#include "core/operations/resample.h"
#include "editor/fields/number_box.h"
#include "editor/panels/accuracy_plot.h"
#include "editor/panels/cost_bars.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class AccuracyWalkTest : public WindowTest {
  protected:
    AccuracyWalkTest() : WindowTest(isDrawn()) {}

    /// Of the whole sample the reference takes minutes: it is walked where pictures are asked for.
    static bool isDrawn() { return !qEnvironmentVariableIsEmpty("HAIRLOOM_VIEWPORT"); }
    void openFew() {
        Groom few = groom();
        ASSERT_TRUE(resample(few, {12}));
        few = firstStrands(few, 200);
        few.simulation = groom().simulation;
        document().open(few, {}, "few");
    }
    int clicks() const { return clicks_; }
    void clickTab(const QString& words) {
        for (auto* tabs : window->findChildren<QTabBar*>()) {
            for (int i = 0; i < tabs->count(); ++i) {
                if (!tabs->isVisible() || tabs->tabText(i) != words) continue;
                QTest::mouseClick(tabs, Qt::LeftButton, {}, tabs->tabRect(i).center());
                ++clicks_;
                return QCoreApplication::processEvents();
            }
        }
        ADD_FAILURE() << "no tab says " << words.toStdString();
    }
    /// One that is seen without scrolling.
    void click(const QString& words) {
        for (auto* button : window->findChildren<QPushButton*>()) {
            if (button->text() != words || button->visibleRegion().isEmpty()) continue;
            EXPECT_TRUE(button->isEnabled()) << words.toStdString();
            QTest::mouseClick(button, Qt::LeftButton);
            ++clicks_;
            return QCoreApplication::processEvents();
        }
        ADD_FAILURE() << "no button says " << words.toStdString();
    }
    QString said(const char* label) { return find<QLabel>(label)->text(); }
    /// "0.12 px" of words.
    static double pixelsIn(const QString& words) {
        return QRegularExpression("([0-9.e+-]+) px \\(").match(words).captured(1).toDouble();
    }
    void shoot(const char* name) {
        if (!drawn_) return;
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        EXPECT_TRUE(QDir().mkpath(HAIRLOOM_SCREENSHOTS));
        const QString file = QStringLiteral(HAIRLOOM_SCREENSHOTS "/accuracy-walk-%1.png").arg(name);
        EXPECT_TRUE(window->grab().save(file));
    }

    const bool drawn_ = isDrawn();

  private:
    int clicks_ = 0;
};

TEST_F(AccuracyWalkTest, TheCheapestSettingUnderOnePixelIsFoundByWordsInFourClicks) {
    drawQuickly();
    openHairFromTheFront();
    if (!drawn_) openFew();
    const auto before = hash();
    clickTab("Accuracy");
    EXPECT_TRUE(said("accuracyWords").contains("Measure")) << "says what to press";
    shoot("1-new");
    click("Measure");
    finishWork();
    const QString found = said("accuracyChosen");
    EXPECT_TRUE(found.startsWith("Fastest within 1 px: ")) << found.toStdString();
    EXPECT_LE(pixelsIn(found), 1) << found.toStdString();
    shoot("2-measured");
    click("Apply");
    EXPECT_LE(clicks(), 4);
    EXPECT_NE(hash(), before);
    const QString now = said("accuracyWords");
    EXPECT_TRUE(now.startsWith("Now ")) << now.toStdString();
    EXPECT_EQ(pixelsIn(now), pixelsIn(found)) << now.toStdString();
    EXPECT_TRUE(said("accuracyChosen").contains("This is the current setting"));
    shoot("3-adopted");
    // What else there is: points that say what they are, another limit, and the way back.
    auto* plot = find<AccuracyPlot>("accuracyPlot");
    QTest::mouseMove(plot, plot->place_px(0).toPoint());
    ASSERT_TRUE(QTest::qWaitFor([] { return QToolTip::text().contains(" ms, "); }, kPatience))
        << QToolTip::text().toStdString();
    auto& limit = find<NumberBox>("accuracyMs")->spinBox();
    limit.selectAll();
    QTest::keyClicks(&limit, "99");
    QTest::keyClick(&limit, Qt::Key_Return);
    EXPECT_TRUE(said("accuracyChosen").startsWith("Most accurate within 99 ms: "));
    EXPECT_LE(pixelsIn(said("accuracyChosen")), pixelsIn(found));
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
    // The frame's budget, and what the hair withstands.
    clickTab("Effects");
    trigger("play.toggle");
    auto* effects = find<QTreeWidget>("effects");
    const auto frameCost = [&] {
        return effects->topLevelItem(0)->data(1, CostBars::kMilliseconds).toDouble();
    };
    ASSERT_TRUE(
        QTest::qWaitFor([&] { return effects->topLevelItemCount() > 0 && frameCost() > 0; }, kPatience));
    trigger("play.toggle");
    EXPECT_TRUE(effects->topLevelItem(0)->child(0)->text(0).contains("% of the budget"));
    click("Stress test");
    finishWork();
    EXPECT_TRUE(said("certificateWords").startsWith("Withstands frames of"));
    shoot("4-certified");
}

}  // namespace
}  // namespace hairloom::editor
