// SPDX-License-Identifier: GPL-3.0-or-later
// The Accuracy panel as a new user walks it: measure, read, set a limit in pixels, adopt, undo.
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <ctime>

#include "core/editing/selection_commands.h"
#include "core/operations/resample.h"
#include "editor/fields/number_box.h"
#include "editor/fields/price_tag.h"
#include "editor/panels/accuracy_plot.h"
#include "editor/panels/error_bars.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class AccuracyTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        // Few strands and points: a grid that is measured in seconds.
        Groom few = groom();
        ASSERT_TRUE(resample(few, {12}));
        few = firstStrands(few, 200);
        few.simulation = groom().simulation;  // no spheres: what slides over them converges slowly
        document().open(few, {}, "few");
        window->panel("accuracy")->raise();
        QCoreApplication::processEvents();
    }
    QString words() { return find<QLabel>("accuracyWords")->text(); }
    QString chosen() { return find<QLabel>("accuracyChosen")->text(); }
    QPushButton& adopt() { return *find<QPushButton>("accuracyAdopt"); }
    void measure() {
        find<QPushButton>("accuracyMeasure")->click();
        ASSERT_TRUE(parts().tasks.isBusy());
        finishWork();
    }
};

TEST_F(AccuracyTest, WhatTheNextStepBuysIsSaidAndAdopted) {
    Groom coarse = groom();
    coarse.simulation.substeps = 1;
    document().open(coarse, {}, "coarse");
    EXPECT_TRUE(words().contains("Measure"));
    EXPECT_FALSE(adopt().isEnabled());
    const auto before = hash();
    measure();
    EXPECT_EQ(hash(), before) << "measuring changes nothing";
    EXPECT_TRUE(words().contains("Now 1 substep, 12 points")) << words().toStdString();
    EXPECT_TRUE(words().contains(" px")) << words().toStdString();
    find<NumberBox>("accuracyMs")->spinBox().setValue(100);
    ASSERT_TRUE(adopt().isEnabled()) << words().toStdString();
    const QString setting = chosen();
    adopt().click();
    EXPECT_TRUE(setting.contains(QString("%1 substep").arg(groom().simulation.substeps)))
        << setting.toStdString();
    EXPECT_NE(hash(), before);
    EXPECT_TRUE(words().contains("No measured setting has a smaller error")) << words().toStdString();
    EXPECT_EQ(document().stepCount(), 1);
    EXPECT_FALSE(words().contains("before the last change")) << "the adopted setting has been measured";
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
    EXPECT_TRUE(words().contains("Now 1 substep, 12 points"));
}

TEST_F(AccuracyTest, TheCheapestWithinALimitInPixelsMayHaveFewerPoints) {
    const auto before = hash();
    measure();
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);
    // Of so few strands a busy machine does not tell 1 substep from 4, or 4 points from 6.
    ASSERT_TRUE(chosen().contains(", 4 points") || chosen().contains(", 6 points")) << chosen().toStdString();
    adopt().click();
    EXPECT_LT(groom().strand(0).size(), 12u);
    EXPECT_EQ(document().stepCount(), 1);
    expectSound();
    const auto script = document().editing().script();
    ASSERT_TRUE(script) << script.error().message();
    EXPECT_NE(script->find("resample"), std::string::npos) << "a script can do it again";
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
}

TEST_F(AccuracyTest, APointOfTheDiagramIsChosenByAClick) {
    measure();
    auto* plot = find<AccuracyPlot>("accuracyPlot");
    plot->resize(300, 220);
    const QString none = chosen();
    for (std::size_t run = 0; run < 3; ++run) {
        QTest::mouseClick(plot, Qt::LeftButton, {}, plot->place_px(run).toPoint());
        EXPECT_TRUE(adopt().isEnabled());
        EXPECT_NE(chosen(), none);
    }
}

TEST_F(AccuracyTest, TheDiagramShowsShapePenetrationAndRestToo) {
    auto* measure = find<QComboBox>("accuracyMeasure");
    EXPECT_FALSE(measure->isVisibleTo(measure->parentWidget()));
    auto* plot = find<AccuracyPlot>("accuracyPlot");
    this->measure();
    ASSERT_EQ(measure->count(), 5);
    plot->resize(300, 220);
    const QPointF distance = plot->place_px(0);
    measure->setCurrentIndex(1);
    EXPECT_NE(plot->place_px(0), distance) << "a drop is no distance";
    for (int m = 2; m < measure->count(); ++m) {
        measure->setCurrentIndex(m);
        EXPECT_TRUE(plot->rect().contains(plot->place_px(0).toPoint()));
    }
}

TEST_F(AccuracyTest, WhatAnErrorIsMadeOfIsFourBars) {
    auto* parts = find<ErrorBars>("accuracyParts");
    EXPECT_FALSE(parts->isVisibleTo(parts->parentWidget()));
    measure();
    ASSERT_TRUE(parts->isVisibleTo(parts->parentWidget())) << "of the document's own setting";
    const QString own = parts->words();
    for (const char* name : {"Steps", "Points", "Model", "Uncertainty"}) EXPECT_TRUE(own.contains(name));
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);
    EXPECT_NE(parts->words(), own) << "fewer points, of the chosen one";
    openBust();
    EXPECT_FALSE(parts->isVisibleTo(parts->parentWidget()));
}

TEST_F(AccuracyTest, ASettingIsPricedWhereItIsSet) {
    auto* tag = find<PriceTag>("substepsCost");
    EXPECT_TRUE(tag->words().isEmpty());
    EXPECT_FALSE(tag->isVisibleTo(tag->parentWidget()));
    measure();
    EXPECT_TRUE(tag->isVisibleTo(tag->parentWidget()));
    EXPECT_TRUE(tag->words().contains(" px")) << tag->words().toStdString();
    EXPECT_TRUE(tag->toolTip().contains("Measured at"));
    Groom changed = groom();
    changed.simulation.windSpeed = 3;
    change("Wind", changed);
    EXPECT_TRUE(tag->toolTip().contains("before the last change"));
    openBust();
    EXPECT_FALSE(tag->isVisibleTo(tag->parentWidget())) << "another document has no prices";
}

TEST_F(AccuracyTest, AMeasuredSettingIsShownInTheViewAndLeavesNoTrace) {
    auto* show = find<QPushButton>("accuracyShow");
    EXPECT_FALSE(show->isEnabled());
    const auto before = hash();
    measure();
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);  // fewer points than the hair has
    show->click();
    finishWork();
    ASSERT_TRUE(QTest::qWaitFor([&] { return viewport().pose() != nullptr; }, kPatience));
    const auto first = viewport().pose();
    EXPECT_EQ(first->positions_ws.size(), groom().pointCount());
    ASSERT_TRUE(QTest::qWaitFor([&] { return viewport().pose() != first; }, kPatience)) << "it moves";
    for (const Vec3f& point : viewport().pose()->positions_ws) ASSERT_TRUE(point.allFinite());
    EXPECT_EQ(hash(), before);
    show->click();
    EXPECT_EQ(viewport().pose(), nullptr);
    show->click();
    finishWork();
    adopt().click();
    EXPECT_FALSE(show->isChecked()) << "the document has changed";
    EXPECT_EQ(viewport().pose(), nullptr);
}

TEST_F(AccuracyTest, ASettingIsShownBesideItsPair) {
    auto* beside = find<QComboBox>("accuracyBeside");
    EXPECT_FALSE(beside->isEnabled());
    measure();
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);
    EXPECT_FALSE(chosen().contains("in blue")) << "blue is the reference";
    beside->setCurrentIndex(3);
    EXPECT_TRUE(chosen().contains("Shown in blue: 2 substeps, 12 points")) << chosen().toStdString();
    find<QPushButton>("accuracyShow")->click();
    finishWork();
    ASSERT_TRUE(QTest::qWaitFor([&] { return viewport().pose() != nullptr; }, kPatience));
    for (const int other : {1, 2, 0}) {
        beside->setCurrentIndex(other);
        finishWork();
        EXPECT_TRUE(find<QPushButton>("accuracyShow")->isChecked());
        EXPECT_EQ(chosen().contains("blue"), other != 0) << chosen().toStdString();
    }
}

TEST_F(AccuracyTest, TheStrandsThatMatterMostAreSelected) {
    measure();
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);
    find<QPushButton>("accuracyWorst")->click();
    finishWork();
    const auto selected = editing::strandsWithFlag(groom(), attribute::kSelected);
    EXPECT_EQ(selected.size(), 10u) << "a twentieth of 200";
    trigger("edit.undo");
    EXPECT_TRUE(editing::strandsWithFlag(groom(), attribute::kSelected).empty());
    find<NumberBox>("accuracyMs")->spinBox().setValue(100);
    find<QPushButton>("accuracyWorst")->click();
    EXPECT_FALSE(parts().tasks.isBusy()) << "the most exact has no worst";
}

TEST_F(AccuracyTest, AThousandStormsSayWhatTheHairWithstands) {
    auto* words = find<QLabel>("certificateWords");
    EXPECT_FALSE(words->isVisibleTo(window.get()));
    find<QPushButton>("certify")->click();
    finishWork();
    EXPECT_TRUE(words->text().startsWith("Withstands frames of")) << words->text().toStdString();
    EXPECT_TRUE(words->text().contains("1000 random storms"));
    EXPECT_TRUE(words->text().contains("Tested at")) << words->text().toStdString();
    Groom changed = groom();
    changed.simulation.windSpeed = 3;
    change("Wind", changed);
    EXPECT_TRUE(words->text().startsWith("Before the last change")) << words->text().toStdString();
    openBust();
    EXPECT_TRUE(words->text().isEmpty());
}

TEST_F(AccuracyTest, WhatChangesWhileItMeasuresIsTold) {
    find<QPushButton>("accuracyMeasure")->click();
    Groom changed = groom();
    changed.simulation.windSpeed = 3;
    change("Wind", changed);
    trigger("edit.undo");
    finishWork();
    EXPECT_TRUE(words().contains("before the last change")) << words().toStdString();
    find<QPushButton>("accuracyMeasure")->click();
    openFirstStrands(5);
    finishWork();
    EXPECT_FALSE(adopt().isEnabled()) << "was of another document";
    EXPECT_TRUE(words().contains("How accurate")) << words().toStdString();
}

TEST_F(AccuracyTest, ACancelledRunDoesNotMakeTheLastOneNew) {
    measure();
    Groom changed = groom();
    changed.simulation.windSpeed = 3;
    change("Wind", changed);
    find<QPushButton>("accuracyMeasure")->click();
    parts().tasks.cancel();
    finishWork();
    EXPECT_TRUE(words().contains("before the last change")) << words().toStdString();
}

TEST_F(AccuracyTest, WhatIsCheapestWithinTheLimitIsChosenAtOnce) {
    EXPECT_FALSE(adopt().isEnabled());
    measure();
    EXPECT_TRUE(chosen().startsWith("Fastest within 1 px: ")) << chosen().toStdString();
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);
    adopt().click();
    EXPECT_TRUE(chosen().contains("This is the current setting")) << chosen().toStdString();
    EXPECT_FALSE(adopt().isEnabled()) << "it would be a step that changes nothing";
    find<NumberBox>("accuracyMs")->spinBox().setValue(0.01);
    EXPECT_TRUE(chosen() == "No measured setting is within 0.01 ms." || chosen().contains("0.01 ms: "))
        << chosen().toStdString();
    // Pixels are the view's: nearer, the same limit asks for more.
    find<NumberBox>("accuracyPixels")->spinBox().setValue(0.5);
    const QString far = chosen();
    viewport().camera().zoom(1000);
    QEnterEvent over({}, {}, {});
    QCoreApplication::sendEvent(find<QPushButton>("accuracyMeasure")->parentWidget(), &over);
    EXPECT_NE(chosen(), far);
}

TEST_F(AccuracyTest, APointOfAnOldDiagramIsNoneOfTheNewOne) {
    measure();
    Groom coarse = groom();
    ASSERT_TRUE(resample(coarse, {4}));  // fewer points to try, so fewer runs
    document().perform(editing::replaceGroom(document().editing().model(), coarse, "Coarse", {}));
    auto* plot = find<AccuracyPlot>("accuracyPlot");
    plot->resize(300, 220);
    find<QPushButton>("accuracyMeasure")->click();
    for (std::size_t run = 21; run-- > 0;)
        QTest::mouseClick(plot, Qt::LeftButton, {}, plot->place_px(run % 18).toPoint());
    finishWork();
    EXPECT_TRUE(chosen().contains("4 points") || chosen().startsWith("No measured setting"))
        << chosen().toStdString();
    expectSound();
}

TEST_F(AccuracyTest, TheLastSettingAskedForIsTheOneThatIsShown) {
    measure();
    auto* show = find<QPushButton>("accuracyShow");
    auto& pixels = find<NumberBox>("accuracyPixels")->spinBox();
    pixels.setValue(100);
    show->click();
    pixels.setValue(0.02);  // while the first is simulated
    pixels.setValue(100);
    finishWork();
    finishWork();
    EXPECT_TRUE(show->isChecked()) << "a slider does not end it";
    ASSERT_TRUE(QTest::qWaitFor([&] { return viewport().pose() != nullptr; }, kPatience));
    pixels.setValue(0.02);
    parts().tasks.cancel();
    finishWork();
    EXPECT_TRUE(show->isChecked()) << "what was shown goes on";
    show->click();
    EXPECT_EQ(viewport().pose(), nullptr);
    show->click();
    parts().tasks.cancel();
    finishWork();
    EXPECT_FALSE(show->isChecked()) << "nothing is shown";
}

TEST_F(AccuracyTest, LeavingTheProgramDoesNotWaitForTheReference) {
    openSampleHair("long");  // with its spheres: a minute of the reference
    // Processor time, which other work on this machine does not lengthen.
    const auto seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    const double begin = seconds();
    find<QPushButton>("accuracyMeasure")->click();
    ASSERT_TRUE(QTest::qWaitFor([&] { return seconds() > begin + 2; }, kPatience)) << "it is under way";
    ASSERT_TRUE(parts().tasks.isBusy());
    const double cancelled = seconds();
    parts().tasks.cancel();
    finishWork();
    EXPECT_LT(seconds() - cancelled, 5);
    EXPECT_FALSE(adopt().isEnabled()) << "nothing was measured to its end";
}

TEST_F(AccuracyTest, OneStrandOfTwoPointsIsMeasuredToo) {
    Groom one = firstStrands(groom(), 1);
    ASSERT_TRUE(resample(one, {2}));
    document().open(one, {}, "one");
    measure();
    EXPECT_TRUE(words().contains("2 points")) << words().toStdString();
    find<QComboBox>("accuracyMeasure")->setCurrentIndex(2);
    find<NumberBox>("accuracyPixels")->spinBox().setValue(100);
    if (adopt().isEnabled()) adopt().click();
    expectSound();
}

TEST_F(AccuracyTest, AnotherDocumentAndACancelledRunLeaveNothing) {
    find<QPushButton>("accuracyMeasure")->click();
    parts().tasks.cancel();
    finishWork();
    EXPECT_FALSE(adopt().isEnabled());
    measure();
    Groom changed = groom();
    changed.simulation.windSpeed = 3;
    change("Wind", changed);
    EXPECT_TRUE(words().contains("before the last change"));
    openBust();
    EXPECT_FALSE(adopt().isEnabled());
    EXPECT_TRUE(words().contains("Place hair"));
}

}  // namespace
}  // namespace hairloom::editor
