// SPDX-License-Identifier: GPL-3.0-or-later
// The panels about motion: what runs before and while it plays, effects left out for a try, the stiffness
// curve.
#include <QMouseEvent>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <algorithm>

#include "editor/fields/number_box.h"
#include "editor/fields/stiffness_curve.h"
#include "editor/panels/cost_bars.h"
#include "editor/panels/stability_gauge.h"
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
        change("Wind", windy);
        window->panel("effects")->raise();
        QCoreApplication::processEvents();
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
        return QTest::qWaitFor([&] { return row(effect) != nullptr; }, kPatience);
    }
    /// Of a row as it is shown; 0 while it shows none.
    double milliseconds(const char* effect) {
        const auto* shown = row(effect);
        return shown ? shown->data(1, CostBars::kMilliseconds).toDouble() : 0;
    }
    /// The panel follows the frames that play in its own time.
    bool waitForMilliseconds(const char* effect) {
        return QTest::qWaitFor([&] { return milliseconds(effect) > 0; }, kPatience);
    }
    bool isOn(const char* name) {
        for (const EffectReport& effect : parts().player.effects()) {
            if (effect.name == name) return effect.on;
        }
        ADD_FAILURE() << "no effect " << name;
        return false;
    }
    /// Frames that are under way when the plan changes are of the one before.
    bool becomes(const char* effect, bool on) {
        return QTest::qWaitFor([&] { return isOn(effect) == on; }, kPatience);
    }
    bool play(double seconds) {
        if (!parts().player.isPlaying()) trigger("play.toggle");
        const auto& frame = parts().player.frame();
        const double from = frame ? frame->time : 0;
        return QTest::qWaitFor(
            [&] {
                const auto& now = parts().player.frame();
                return now && now->time > from + seconds;
            },
            kPatience);
    }
};

TEST_F(EffectsTest, PanelPreviewsThePlanBeforePlaying) {
    ASSERT_TRUE(waitForRow("wind"));
    EXPECT_FALSE(parts().player.frame());
    EXPECT_TRUE(becomes("wind", true));
    EXPECT_FALSE(row("wind")->child(0)->text(0).isEmpty());
    Groom still = groom();
    still.simulation.windSpeed = 0;
    change("Wind", still);
    EXPECT_TRUE(QTest::qWaitFor([&] { return !isOn("wind"); }, kPatience)) << "follows the settings";
}

TEST_F(EffectsTest, DisablingAnEffectForNowKeepsTheDocument) {
    ASSERT_TRUE(waitForRow("wind"));
    const auto before = hash();
    ASSERT_TRUE(play(0.1));
    EXPECT_TRUE(becomes("wind", true));
    EXPECT_TRUE(waitForMilliseconds("solve")) << "milliseconds are live";
    row("wind")->setCheckState(0, Qt::Unchecked);
    EXPECT_EQ(parts().player.leftOut(), QStringList{"wind"});
    EXPECT_TRUE(becomes("wind", false));
    row("collision")->setCheckState(0, Qt::Unchecked);
    EXPECT_TRUE(becomes("collision", false));
    EXPECT_FALSE(isOn("wind"));
    EXPECT_TRUE(play(0.1));
    EXPECT_EQ(hash(), before);
    find<QPushButton>("effectsAll")->click();
    EXPECT_TRUE(becomes("wind", true));
    EXPECT_TRUE(becomes("collision", true));
    EXPECT_EQ(hash(), before);
}

TEST_F(EffectsTest, EachEffectIsMeasuredOnAndOff) {
    ASSERT_TRUE(waitForRow("wind"));
    const auto before = hash();
    EXPECT_EQ(row("wind")->text(1), "–");
    find<QPushButton>("effectsMeasure")->click();
    EXPECT_TRUE(parts().tasks.isBusy());
    parts().tasks.finish();
    EXPECT_NE(row("wind")->text(1), "–");
    EXPECT_TRUE(row("wind")->toolTip(1).contains("without"));
    EXPECT_EQ(hash(), before);
    find<QPushButton>("effectsMeasure")->click();
    parts().tasks.cancel();
    parts().tasks.finish();
    EXPECT_FALSE(parts().tasks.isBusy());
}

TEST_F(EffectsTest, BarsShowWhatAFrameTakesAgainstTheBudget) {
    ASSERT_TRUE(waitForRow("wind"));
    EXPECT_EQ(milliseconds("frame"), 0) << "nothing has played";
    ASSERT_TRUE(play(0.2));
    ASSERT_TRUE(waitForMilliseconds("frame"));
    trigger("play.toggle");
    double sum = 0;
    for (const EffectReport& effect : parts().player.effects()) sum += milliseconds(effect.name.c_str());
    const double frame = milliseconds("frame");
    EXPECT_GT(frame, 0);
    EXPECT_NEAR(sum, frame, 0.01 * frame) << "the effects share the frame";
    auto* budget = find<NumberBox>("effectsBudget");
    budget->spinBox().setValue(2);
    // Of the frames that were told of last.
    const double share = milliseconds("frame") / 2;
    EXPECT_TRUE(row("frame")->child(0)->text(0).startsWith(QString::number(100 * share, 'f', 0)))
        << row("frame")->child(0)->text(0).toStdString();
}

TEST_F(EffectsTest, EachIntegratorsFailingStepIsShownWithTheSettingAsADot) {
    auto* map = find<StepMap>("stepMap");
    ASSERT_TRUE(QTest::qWaitFor([&] { return map->words().contains("now rods at 8.3 ms"); }, kPatience))
        << map->words().toStdString();
    EXPECT_TRUE(map->words().contains("rods fails at no step"));
    Groom springs = groom();
    springs.simulation.strandModel = runtime::StrandModel::springs;
    springs.simulation.integrator = runtime::Integrator::rk4;
    springs.simulation.substeps = 16;
    change("Springs", springs);
    ASSERT_TRUE(QTest::qWaitFor([&] { return map->words().contains("now rk4 at 1 ms"); }, kPatience))
        << map->words().toStdString();
    EXPECT_TRUE(map->words().contains("rk4 fails beyond a substep of")) << map->words().toStdString();
}

TEST_F(EffectsTest, TemporaryChangeCanBeApplied) {
    ASSERT_TRUE(waitForRow("wind"));
    const auto before = hash();
    row("wind")->setCheckState(0, Qt::Unchecked);
    find<QPushButton>("effectsKeep")->click();
    EXPECT_EQ(groom().simulation.windSpeed, 0);
    EXPECT_TRUE(parts().player.leftOut().isEmpty());
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
}

TEST_F(EffectsTest, HiddenGaugeRefreshesWhenShown) {
    auto* const gauge = window->findChild<StabilityGauge*>();
    ASSERT_TRUE(gauge);
    const auto factor = [&] { return gauge->advice().region.factor; };
    window->panel("effects")->hide();
    const double before = factor();
    Groom explicitly = groom();
    explicitly.simulation.strandModel = runtime::StrandModel::springs;
    explicitly.simulation.integrator = runtime::Integrator::velocityVerlet;
    explicitly.simulation.angularMethod = runtime::AngularMethod::smallAngle;
    change("Integrator", explicitly);
    QTest::qWait(300);
    EXPECT_EQ(factor(), before);
    window->panel("effects")->show();
    window->panel("effects")->raise();
    EXPECT_TRUE(QTest::qWaitFor([&] { return factor() > before; }, kPatience));
    const int margin = find<QProgressBar>("stability")->value();
    EXPECT_NEAR(margin, std::max(3.0, 100 * (1 - factor())), 1);
    EXPECT_LT(margin, 100);
}

class StiffnessTest : public EffectsTest {
  protected:
    void SetUp() override {
        EffectsTest::SetUp();
        window->panel("physics")->raise();
        QCoreApplication::processEvents();
        curve = find<StiffnessCurve>("stiffnessCurve");
        Groom straight = groom();
        straight.simulation.angularStiffness = 0.9f;
        straight.simulation.angularCurve = runtime::Ramp::straight(1, 0.8f);
        change("Straight", straight);
    }
    const runtime::SimulationSettings& settings() { return groom().simulation; }
    float levelOf(std::uint32_t key) {
        return settings().angularStiffness * settings().angularCurve.keys[key].value;
    }
    void dragFrom(const QPoint& from, const QPoint& way) {
        QTest::mousePress(curve, Qt::LeftButton, {}, from);
        for (const QPoint& to : {from + way / 2, from + way}) {
            QMouseEvent move(QEvent::MouseMove, QPointF(to), curve->mapToGlobal(QPointF(to)), Qt::NoButton,
                             Qt::LeftButton, {});
            QCoreApplication::sendEvent(curve, &move);
        }
        QTest::mouseRelease(curve, Qt::LeftButton, {}, from + way);
    }
    QPoint handle(std::uint32_t key) { return curve->handle_px(key).toPoint(); }

    StiffnessCurve* curve = nullptr;
};

TEST_F(StiffnessTest, KeysAreDraggedAndOthersStay) {
    const auto before = hash();
    const int steps = document().stepCount();
    dragFrom(handle(1), {0, 20});
    EXPECT_EQ(settings().angularStiffness, 0.9f);
    EXPECT_LT(levelOf(1), 0.7f);
    EXPECT_EQ(document().stepCount(), steps + 1) << "one drag is one step";
    const float tip = levelOf(1);
    dragFrom(handle(0), {30, 10});
    EXPECT_LT(settings().angularStiffness, 0.9f);
    EXPECT_EQ(settings().angularCurve.keys[0], (runtime::Ramp::Key{0, 1})) << "ends stay at the ends";
    EXPECT_NEAR(levelOf(1), tip, 1e-5f);
    dragFrom(handle(1), {0, -200});
    EXPECT_EQ(settings().angularStiffness, 1) << "the greatest along the strand";
    EXPECT_LT(levelOf(0), 0.9f);
    document().goToStep(steps);
    EXPECT_EQ(hash(), before);
}

TEST_F(StiffnessTest, KeysComeAndGo) {
    const auto before = hash();
    const int steps = document().stepCount();
    const QPoint middle = (handle(0) + handle(1)) / 2;
    dragFrom(middle, {10, 25});
    EXPECT_EQ(document().stepCount(), steps + 1);
    ASSERT_EQ(settings().angularCurve.count, 3u);
    EXPECT_GT(settings().angularCurve.keys[1].at, 0.5f);
    EXPECT_LT(levelOf(1), 0.7f);
    EXPECT_TRUE(runtime::validate(settings()).empty());
    const auto three = hash();
    dragFrom(handle(1), {4000, 0});
    EXPECT_LT(settings().angularCurve.keys[1].at, 1) << "no key passes another";
    EXPECT_TRUE(runtime::validate(settings()).empty());
    trigger("edit.undo");
    EXPECT_EQ(hash(), three);
    QTest::mouseClick(curve, Qt::RightButton, {}, handle(0));
    EXPECT_EQ(settings().angularCurve.count, 3u) << "ends are not removed";
    QTest::mouseClick(curve, Qt::LeftButton, {}, handle(1));
    curve->setFocus();
    QTest::keyClick(curve, Qt::Key_Down);
    EXPECT_NE(hash(), three);
    QTest::keyClick(curve, Qt::Key_Delete);
    EXPECT_EQ(settings().angularCurve, runtime::Ramp::straight(1, 0.8f));
    trigger("edit.undo");
    trigger("edit.undo");
    EXPECT_EQ(hash(), three);
    document().goToStep(steps);
    EXPECT_EQ(hash(), before);
    document().goToStep(steps + 1);
    EXPECT_EQ(hash(), three);
}

TEST_F(StiffnessTest, TheHairMovesWhereItWasMadeSoft) {
    const auto positions = [&] { return parts().player.frame()->pose->positions_ws; };
    ASSERT_TRUE(play(1));
    trigger("play.toggle");
    const auto stiff = positions();
    dragFrom((handle(0) + handle(1)) / 2, {0, 200});
    ASSERT_EQ(levelOf(1), 0);
    ASSERT_TRUE(play(1));
    trigger("play.toggle");
    const auto soft = positions();
    float farthest = 0;
    for (std::size_t p = 0; p < soft.size(); ++p) farthest = std::max(farthest, (soft[p] - stiff[p]).norm());
    EXPECT_GT(farthest, 0.01f) << "metres";
}

}  // namespace
}  // namespace hairloom::editor
