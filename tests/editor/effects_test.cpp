// SPDX-License-Identifier: GPL-3.0-or-later
// The panels about motion: what runs before and while it plays, effects left out for a try, the stiffness
// curve.
#include <QMouseEvent>
#include <QPushButton>
#include <QTreeWidget>

#include "editor/fields/stiffness_curve.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class EffectsTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        Groom windy = groom();
        windy.simulation.windSpeed = 6;
        document().change("Wind", Change::Simulation, windy);
    }
    QTreeWidgetItem* row(const QString& effect) {
        auto* table = find<QTreeWidget>("effects");
        for (int i = 0; i < table->topLevelItemCount(); ++i) {
            if (table->topLevelItem(i)->data(0, Qt::UserRole).toString() == effect)
                return table->topLevelItem(i);
        }
        return nullptr;
    }
    bool waitForRow(const QString& effect) {
        return QTest::qWaitFor([&] { return row(effect) != nullptr; }, 20'000);
    }
    bool isOn(const char* name) {
        for (const EffectReport& effect : session().player.effects()) {
            if (effect.name == name) return effect.on;
        }
        ADD_FAILURE() << "no effect " << name;
        return false;
    }
    bool play(double seconds) {
        if (!session().player.isPlaying()) trigger("play.toggle");
        const auto& frame = session().player.frame();
        const double from = frame ? frame->time : 0;
        return QTest::qWaitFor(
            [&] {
                const auto& now = session().player.frame();
                return now && now->time > from + seconds;
            },
            30'000);
    }
};

TEST_F(EffectsTest, ThePanelSaysWhatWouldRunBeforeItPlays) {
    ASSERT_TRUE(waitForRow("wind"));
    EXPECT_FALSE(session().player.frame());
    EXPECT_TRUE(isOn("wind"));
    EXPECT_FALSE(row("wind")->text(3).isEmpty());
    Groom still = groom();
    still.simulation.windSpeed = 0;
    document().change("Wind", Change::Simulation, still);
    EXPECT_TRUE(QTest::qWaitFor([&] { return !isOn("wind"); }, 20'000)) << "follows the settings";
}

TEST_F(EffectsTest, AnEffectIsLeftOutForATryAndTheDocumentStays) {
    ASSERT_TRUE(waitForRow("wind"));
    const auto before = hash();
    ASSERT_TRUE(play(0.1));
    EXPECT_TRUE(isOn("wind"));
    EXPECT_GT(row("wind")->text(1).toDouble(), 0) << "milliseconds are live";
    row("wind")->setCheckState(0, Qt::Unchecked);
    EXPECT_EQ(session().player.leftOut(), QStringList{"wind"});
    ASSERT_TRUE(play(0.1));
    EXPECT_FALSE(isOn("wind"));
    row("collision")->setCheckState(0, Qt::Unchecked);
    ASSERT_TRUE(play(0.1));
    EXPECT_FALSE(isOn("collision"));
    EXPECT_EQ(hash(), before);
    find<QPushButton>("effectsAll")->click();
    ASSERT_TRUE(play(0.1));
    EXPECT_TRUE(isOn("wind"));
    EXPECT_TRUE(isOn("collision"));
    EXPECT_EQ(hash(), before);
}

TEST_F(EffectsTest, WhatWasTriedCanBeKept) {
    ASSERT_TRUE(waitForRow("wind"));
    const auto before = hash();
    row("wind")->setCheckState(0, Qt::Unchecked);
    find<QPushButton>("effectsKeep")->click();
    EXPECT_EQ(groom().simulation.windSpeed, 0);
    EXPECT_TRUE(session().player.leftOut().isEmpty());
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
}

TEST_F(EffectsTest, TheEndsOfTheStiffnessCurveAreDragged) {
    window->panel("physics")->raise();
    QCoreApplication::processEvents();
    auto* curve = find<StiffnessCurve>("stiffnessCurve");
    const auto before = hash();
    const int steps = document().stepCount();
    const auto dragEnd = [&](int end, int down) {
        const QPoint from = curve->handle_px(end).toPoint();
        QTest::mousePress(curve, Qt::LeftButton, {}, from);
        QMouseEvent move(QEvent::MouseMove, from + QPointF(0, down),
                         curve->mapToGlobal(from + QPoint(0, down)), Qt::NoButton, Qt::LeftButton, {});
        QCoreApplication::sendEvent(curve, &move);
        QTest::mouseRelease(curve, Qt::LeftButton, {}, from + QPoint(0, down));
    };
    const auto was = groom().simulation;
    const float tipWas = was.angularStiffness * was.angularTipShare;
    dragEnd(1, 20);
    EXPECT_EQ(groom().simulation.angularStiffness, was.angularStiffness);
    EXPECT_LT(groom().simulation.angularTipShare, was.angularTipShare);
    EXPECT_EQ(document().stepCount(), steps + 1);
    const float tip = groom().simulation.angularStiffness * groom().simulation.angularTipShare;
    EXPECT_LT(tip, tipWas);
    dragEnd(0, 10);
    EXPECT_LT(groom().simulation.angularStiffness, was.angularStiffness);
    EXPECT_NEAR(groom().simulation.angularStiffness * groom().simulation.angularTipShare, tip, 1e-5f)
        << "the tip stays";
    document().goToStep(steps);
    EXPECT_EQ(hash(), before);
}

}  // namespace
}  // namespace hairloom::editor
