// SPDX-License-Identifier: GPL-3.0-or-later
// The panel of the time line as an animator uses it: key, drag, scrub, undo.

#include <gtest/gtest.h>

#include <QComboBox>
#include <QContextMenuEvent>
#include <QLabel>
#include <QMenu>
#include <QScrollArea>
#include <QToolButton>
#include <ctime>

#include "core/animation/actor.h"
#include "core/groom/time_line_keys.h"
#include "editor/fields/number_box.h"
#include "editor/fields/number_spin.h"
#include "editor/panels/key_curves.h"
#include "editor/panels/time_ruler.h"
#include "editor/panels/track_rows.h"
#include "tests/editor/nothing_clipped.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

const KeyTrack kSpeed{KeyTrack::Of::setting, "simulation.windSpeed"}, kHead{KeyTrack::Of::head, {}},
    kClips{KeyTrack::Of::clips, {}};

class TimeLinePanelTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        window->activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
        openSampleHair("short");
        openFirstStrands(20);
    }
    const TimeLine& line() { return timeLineOf(groom()); }
    Player& player() { return parts().player; }
    TrackRows& rows() { return *find<TrackRows>("timeTracks"); }
    void set(const TimeLine& line) { ASSERT_TRUE(parts().keying.change(line, "Time line")); }
    /// Keys of wind speed at 0, 1 and 2 s of 4.
    TimeLine windy() {
        TimeLine line;
        line.framesPerSecond = 30;
        for (const float time : {0.0f, 1.0f, 2.0f}) keySetting(line, kSpeed.name, time, {2 * time, 0, 0});
        return line;
    }
    /// What a right-click on a control offers, by the words that it begins with.
    void chooseInMenu(QWidget& control, const QString& words) {
        // As a person scrolls to it; a menu that begins outside of the screen closes at once.
        QCoreApplication::processEvents();
        for (QWidget* around = control.parentWidget(); around; around = around->parentWidget()) {
            if (auto* area = qobject_cast<QScrollArea*>(around)) area->ensureWidgetVisible(&control);
        }
        bool chosen = false;
        QTimer timer;
        QObject::connect(&timer, &QTimer::timeout, [&] {
            auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
            if (!menu) return;
            for (QAction* action : menu->actions()) {
                if (!action->text().startsWith(words)) continue;
                chosen = action->isEnabled();
                // As a click does: it closes the menu and runs.
                menu->setActiveAction(action);
                QTest::keyClick(menu, Qt::Key_Return);
                return;
            }
            menu->close();
        });
        timer.start(20);
        const QPoint middle = control.rect().center();
        QContextMenuEvent event(QContextMenuEvent::Mouse, middle, control.mapToGlobal(middle));
        QCoreApplication::sendEvent(&control, &event);
        EXPECT_TRUE(chosen) << words.toStdString() << " at " << event.globalX() << ", " << event.globalY();
    }
    /// In three steps, as a hand does.
    static void dragIn(QWidget& widget, const QPoint& from, const QPoint& to) {
        QTest::mousePress(&widget, Qt::LeftButton, {}, from);
        for (const QPoint& at : {(from + to) / 2, to}) {
            QMouseEvent move(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::LeftButton, Qt::LeftButton,
                             Qt::NoModifier);
            QCoreApplication::sendEvent(&widget, &move);
        }
        QTest::mouseRelease(&widget, Qt::LeftButton, {}, to);
    }
    /// Pixels of `frames` in the rows.
    int across(int frames) {
        const double first = rows().placeOf({kSpeed, 0}).x(), second = rows().placeOf({kSpeed, 1}).x();
        return static_cast<int>(std::lround((second - first) / 30 * frames));
    }
};

TEST_F(TimeLinePanelTest, KeyThisOnAFieldKeysItAtThePlayHead) {
    QDockWidget* const panel = window->panel("time_line");
    EXPECT_FALSE(panel->isVisible()) << "there is nothing on it yet";
    panel->show();
    QCoreApplication::processEvents();
    EXPECT_TRUE(find<QLabel>("timeNone")->isVisible());
    auto* speed = window->panel("physics")->findChild<NumberBox*>("windSpeed");
    ASSERT_TRUE(speed);
    const int before = document().doneSteps();
    chooseInMenu(*speed, "Key this at frame 0");
    EXPECT_EQ(document().doneSteps(), before + 1) << "one step";
    EXPECT_EQ(player().motion(), "timeline");
    player().scrub(1);
    Groom windier = groom();
    windier.simulation.windSpeed = 8;
    change("Wind speed", windier);
    chooseInMenu(speed->spinBox(), "Key this at frame 60");
    EXPECT_EQ(player().lineFrame(), 60) << "the play head stays";
    ASSERT_EQ(keyTimes(line(), kSpeed), (std::vector<float>{0, 1}));
    EXPECT_EQ(numberOf(line(), {kSpeed, 1}, 0), 8);
    EXPECT_TRUE(find<TrackRows>("timeTracks")->isVisible());
    const auto marked = [&](const QString& mark) {
        for (const auto* label : window->panel("physics")->findChildren<QLabel*>()) {
            if (label->buddy() == speed) return label->text() == mark + "Wind speed";
        }
        return false;
    };
    EXPECT_TRUE(marked("◆ "));
    player().scrubFrames(-20);
    EXPECT_TRUE(marked("◇ ")) << "keyed, but not here";
    chooseInMenu(*speed, "Remove keys");
    EXPECT_TRUE(line().isEmpty());
    EXPECT_TRUE(marked(""));
    trigger("edit.undo");
    EXPECT_EQ(keyTimes(line(), kSpeed).size(), 2u);
    // A curve over the strand cannot be keyed.
    EXPECT_EQ(findKeyable("simulation.stiffnessRamp"), nullptr);
}

TEST_F(TimeLinePanelTest, TheLookIsKeyedAndShownAtThePlayHead) {
    const KeyTrack shininess{KeyTrack::Of::setting, "material.shininess"};
    auto* control = window->panel("look")->findChild<NumberBox*>("shininess");
    ASSERT_TRUE(control);
    chooseInMenu(*control, "Key this at frame 0");
    EXPECT_EQ(keyTimes(line(), shininess).size(), 1u);
    EXPECT_EQ(numberOf(line(), {shininess, 0}, 0), double{groom().material.shininess});
    player().scrub(0.5f);
    ASSERT_TRUE(viewport().pose());
    EXPECT_EQ(viewport().pose()->lineTime, 0.5f);
    // Which strands are white is no matter of a frame.
    EXPECT_EQ(findKeyable("material.greyShare"), nullptr);
    ASSERT_TRUE(player().setMotion("none"));
    player().scrub(0.5f);
    ASSERT_TRUE(viewport().pose());
    EXPECT_FALSE(viewport().pose()->lineTime) << "another motion has no keys";
}

TEST_F(TimeLinePanelTest, KeysAreDraggedCopiedEditedAndDeletedEachAsOneStep) {
    set(windy());
    EXPECT_TRUE(window->panel("time_line")->isVisible()) << "what is keyed is seen";
    QCoreApplication::processEvents();
    int steps = document().doneSteps();
    const QPoint second = rows().placeOf({kSpeed, 1});
    EXPECT_TRUE(find<QLabel>("keyNone")->isVisible()) << "what the room beside the keys is for";
    dragIn(rows(), second, second + QPoint(across(6), 0));
    EXPECT_EQ(document().doneSteps(), ++steps);
    EXPECT_NEAR(keyTimes(line(), kSpeed)[1], 1.2, 1e-5);
    // Double-click: the value is typed with its unit.
    const QPoint moved = rows().placeOf({kSpeed, 1});
    QTest::mouseDClick(&rows(), Qt::LeftButton, {}, moved);
    auto* value = find<QDoubleSpinBox>("keyNumber0");
    EXPECT_TRUE(value->hasFocus());
    EXPECT_TRUE(value->text().endsWith("m/s")) << value->text().toStdString();
    QTest::keyClicks(value, "6,5");
    QTest::keyClick(value, Qt::Key_Return);
    EXPECT_EQ(document().doneSteps(), ++steps);
    EXPECT_EQ(numberOf(line(), {kSpeed, 1}, 0), 6.5);
    auto* between = find<QComboBox>("keyInterpolation");
    between->setCurrentIndex(2);
    Q_EMIT between->activated(2);
    EXPECT_EQ(interpolationOf(line(), {kSpeed, 1}), KeyInterpolation::smooth);
    EXPECT_EQ(document().doneSteps(), ++steps);
    player().scrub(3);
    rows().setFocus();
    QTest::keyClick(&rows(), Qt::Key_D, Qt::ControlModifier);
    EXPECT_EQ(document().doneSteps(), ++steps);
    ASSERT_EQ(keyTimes(line(), kSpeed).size(), 4u);
    EXPECT_EQ(keyTimes(line(), kSpeed)[3], 3);
    QTest::keyClick(&rows(), Qt::Key_Right, Qt::AltModifier);
    EXPECT_NEAR(keyTimes(line(), kSpeed)[3], 3 + 1.0 / 30, 1e-5);
    ++steps;
    QTest::keyClick(&rows(), Qt::Key_Delete);
    EXPECT_EQ(document().doneSteps(), ++steps);
    EXPECT_EQ(keyTimes(line(), kSpeed).size(), 3u);
    EXPECT_EQ(groom().strandCount(), 20u) << "keys, not strands";
    QTest::keyClick(&rows(), Qt::Key_A, Qt::ControlModifier);
    QTest::keyClick(&rows(), Qt::Key_Delete);
    EXPECT_TRUE(line().isEmpty());
    while (document().doneSteps() > steps - 6) trigger("edit.undo");
    EXPECT_EQ(line(), windy()) << "undone to where it began";
}

TEST_F(TimeLinePanelTest, ScrubbingShowsWhatPlayedElseThePosedHead) {
    TimeLine line = windy();
    line.end = 0.3f;
    line.loop = false;
    keyHead(line, {0});
    HeadKey turned;
    turned.time = 0.3f;
    turned.degrees = 60;
    keyHead(line, turned);
    set(line);
    player().scrub(0.2f);
    EXPECT_EQ(player().shown(), Player::Shown::posed);
    EXPECT_TRUE(find<QLabel>("timeState")->text().contains("not simulated"));
    const auto posed = player().pose();
    ASSERT_TRUE(posed);
    const Eigen::AngleAxisf turn(posed->head.head_ws.linear());
    EXPECT_NEAR(degrees(turn.angle()), 40, 0.01) << "two thirds of the turn";
    EXPECT_LT((posed->positions_ws[5] - posed->head.head_ws * groom().positions()[5]).norm(), 1e-6f);
    trigger("play.toggle");
    EXPECT_FALSE(player().isScrubbed());
    ASSERT_TRUE(QTest::qWaitFor([&] { return !player().isPlaying(); }, kPatience));
    const auto last = player().frame();
    ASSERT_TRUE(last);
    EXPECT_EQ(player().frameCache().runs(), (std::vector<std::pair<std::int64_t, std::int64_t>>{{1, 9}}));
    std::vector<Vec3f> before;
    for (int frame = 8; frame > 0; --frame) {
        trigger("play.stepBack");
        EXPECT_EQ(player().lineFrame(), frame);
        EXPECT_EQ(player().shown(), Player::Shown::played);
        EXPECT_NE(player().pose()->positions_ws, before);
        before = player().pose()->positions_ws;
    }
    QTest::keyClick(find<TimeRuler>("timeRuler"), Qt::Key_End);
    EXPECT_EQ(player().pose(), last->pose) << "forward again, the very frame";
    EXPECT_EQ(player().shown(), Player::Shown::simulated);
    // What played is of other settings once one changes.
    player().scrub(0.2f);
    EXPECT_EQ(player().shown(), Player::Shown::played);
    Groom heavier = groom();
    heavier.simulation.gravity = {0, -3, 0};
    change("Gravity", heavier);
    EXPECT_EQ(player().shown(), Player::Shown::posed);
    EXPECT_TRUE(player().frameCache().runs().empty());
    trigger("play.reset");
    EXPECT_EQ(player().shown(), Player::Shown::rest);
    // Forward from the last frame that was simulated simulates, elsewhere it moves the play head.
    const auto forward = [&](double seconds) {
        trigger("play.step");
        return QTest::qWaitFor([&] { return player().frame() && player().frame()->time > seconds; },
                               kPatience);
    };
    ASSERT_TRUE(forward(0.02));
    ASSERT_TRUE(forward(0.05));
    trigger("play.stepBack");
    EXPECT_EQ(player().shown(), Player::Shown::played);
    trigger("play.step");
    EXPECT_EQ(player().lineFrame(), 2);
    EXPECT_EQ(player().shown(), Player::Shown::simulated);
    ASSERT_TRUE(forward(0.09));
    EXPECT_EQ(player().lineFrame(), 3);
    player().scrub(0.3f);
    trigger("play.step");
    EXPECT_EQ(player().lineFrame(), 10);
    EXPECT_EQ(player().shown(), Player::Shown::posed);
}

TEST_F(TimeLinePanelTest, TheCacheLetsTheFirstFramesGo) {
    TimeLine line;
    line.framesPerSecond = 10;
    line.loop = false;
    const auto frame = [] {
        auto pose = std::make_shared<HairPose>();
        pose->positions_ws.resize(10'000);
        return pose;
    };
    // Ten, with what each takes beside its points.
    FrameCache cache(line, 105'000 * sizeof(Vec3f));
    for (int f = 1; f <= 25; ++f) cache.add(f / 10.0, frame());
    EXPECT_EQ(cache.runs(), (std::vector<std::pair<std::int64_t, std::int64_t>>{{16, 25}}));
    const auto again = frame();
    cache.add(2, again);
    EXPECT_EQ(cache.at(20), again) << "in place of what was there";
    for (int f = 1; f <= 9; ++f) cache.add(f / 10.0, frame());
    EXPECT_EQ(cache.runs(), (std::vector<std::pair<std::int64_t, std::int64_t>>{{1, 9}, {20, 20}}))
        << "the oldest, wherever they are";
    auto large = frame();
    large->positions_ws.resize(200'000);
    cache.add(1, large);
    EXPECT_TRUE(cache.runs().empty());
}

TEST_F(TimeLinePanelTest, RunsAreOfTheFramesThatAreKept) {
    TimeLine line;
    line.framesPerSecond = 10;
    line.loop = false;
    line.end = 100;
    const auto pose = std::make_shared<HairPose>();
    pose->positions_ws.resize(10'000);
    FrameCache cache(line, 205'000 * sizeof(Vec3f));
    std::uint32_t state = 1;
    for (int i = 0; i < 400; ++i) {
        state = state * 1664525u + 1013904223u;
        cache.add((state >> 16u) % 40 / 10.0, pose);
        std::vector<std::pair<std::int64_t, std::int64_t>> runs;
        for (std::int64_t f = 0; f < 40; ++f) {
            if (!cache.at(f)) continue;
            if (runs.empty() || runs.back().second + 1 != f) runs.emplace_back(f, f);
            runs.back().second = f;
        }
        ASSERT_EQ(cache.runs(), runs) << i;
    }
}

TEST_F(TimeLinePanelTest, OutsideOfTheRangeThePlayHeadShowsItsOwnTime) {
    TimeLine line = windy();
    line.start = 0.2f;
    line.end = 0.4f;
    line.loop = true;
    keyHead(line, {0});
    HeadKey turned;
    turned.time = 0.8f;
    turned.degrees = 80;
    keyHead(line, turned);
    set(line);
    for (const float time : {0.1f, 0.3f, 0.6f, 0.8f}) {
        player().scrub(time);
        ASSERT_TRUE(player().pose());
        const Eigen::AngleAxisf turn(player().pose()->head.head_ws.linear());
        EXPECT_NEAR(degrees(turn.angle()), 100 * time, 0.01) << time;
    }
}

TEST_F(TimeLinePanelTest, TheHeadIsKeyedAsTheHandHasMovedIt) {
    window->panel("time_line")->show();
    player().scrub(0.5f);
    player().setHeadOffset(Eigen::Isometry3f(Eigen::Translation3f(0.1f, 0, 0)));
    EXPECT_FALSE(player().isPlaying()) << "it is posed at the play head";
    EXPECT_NEAR(player().pose()->head.head_ws.translation().x(), 0.1, 1e-6);
    parts().keying.keyHead();
    ASSERT_EQ(line().head.size(), 1u);
    EXPECT_NEAR(line().head[0].translation.x(), 0.1, 1e-6);
    EXPECT_TRUE(player().headOffset().isApprox(Eigen::Isometry3f::Identity()));
    EXPECT_NEAR(player().pose()->head.head_ws.translation().x(), 0.1, 1e-6) << "it stays where it is";
    const Eigen::Isometry3f turn(Eigen::AngleAxisf(radians(30), Vec3f::UnitY()));
    player().scrub(1);
    player().setHeadOffset(turn);
    parts().keying.keyHead();
    ASSERT_EQ(line().head.size(), 2u);
    const Vec3f moved = turn * Vec3f(0.1f, 0, 0);
    EXPECT_LT((line().head[1].translation.cast<float>() - moved).norm(), 1e-5f);
    EXPECT_NEAR(line().head[1].degrees, 30, 1e-3);
    trigger("edit.undo");
    trigger("edit.undo");
    EXPECT_TRUE(line().isEmpty());
}

TEST_F(TimeLinePanelTest, TheWindIsKeyedAsItIsSet) {
    for (const float speed : {4.0f, 10.0f}) {
        Groom windy = groom();
        windy.simulation.windDirection = {0, 0, 2};
        windy.simulation.windSpeed = speed;
        change("Wind", windy);
        player().scrub(speed / 10);
        parts().keying.keyWind();
    }
    ASSERT_EQ(line().wind.size(), 2u);
    EXPECT_EQ(line().wind[0].velocity, Vec3f(0, 0, 4));
    EXPECT_EQ(line().wind[1].velocity, Vec3f(0, 0, 10)) << "as set, whatever the keys say there";
    parts().keying.insertKey({KeyTrack::Of::wind, {}}, 0.7f);
    ASSERT_EQ(line().wind.size(), 3u);
    EXPECT_NEAR(line().wind[1].velocity.z(), 7, 1e-5) << "as the keys say there";
}

TEST_F(TimeLinePanelTest, UndoingASelectedKeyOfWindLeavesItsFields) {
    window->panel("time_line")->show();
    const KeyTrack wind{KeyTrack::Of::wind, {}};
    // The first undo leaves a key before the selected one, the second none.
    for (const float time : {0.0f, 1.0f}) {
        player().scrub(time);
        parts().keying.keyWind();
    }
    QCoreApplication::processEvents();
    for (const std::size_t last : {std::size_t{1}, std::size_t{0}}) {
        QTest::mouseClick(&rows(), Qt::LeftButton, {}, rows().placeOf({wind, last}));
        QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
        QCoreApplication::processEvents();
        ASSERT_TRUE(find<NumberSpin>("keyFrame")->isVisible());
        EXPECT_EQ(find<NumberSpin>("keyFrame")->value(), last == 1 ? 60 : 0);
        trigger("edit.undo");
        EXPECT_EQ(line().wind.size(), last);
        EXPECT_TRUE(find<QLabel>("keyNone")->isVisible() || last == 0);
    }
}

TEST_F(TimeLinePanelTest, WhatIsTypedStaysWhileHairPlays) {
    set(windy());
    window->panel("time_line")->show();
    auto* end = find<NumberSpin>("timeEndFrame");
    ASSERT_TRUE(end);
    const double before = end->value();
    end->setFocus();
    end->selectAll();
    QTest::keyClicks(end, "77");
    Q_EMIT player().frameReady();
    EXPECT_TRUE(end->text().startsWith("77")) << end->text().toStdString();
    EXPECT_EQ(end->value(), before);
    QTest::keyClick(end, Qt::Key_Return);
    EXPECT_EQ(end->value(), 77);
}

TEST_F(TimeLinePanelTest, CurvesAreDragged) {
    set(windy());
    find<QToolButton>("timeCurves")->click();
    QCoreApplication::processEvents();
    auto& curves = *find<KeyCurves>("keyCurves");
    ASSERT_TRUE(curves.isVisible());
    const int steps = document().doneSteps();
    const QPoint from = curves.placeOf({kSpeed, 1}, 0).toPoint();
    const QPoint to(from.x(), curves.placeOf({kSpeed, 2}, 0).toPoint().y());
    dragIn(curves, from, to);
    EXPECT_EQ(document().doneSteps(), steps + 1);
    EXPECT_NEAR(numberOf(line(), {kSpeed, 1}, 0), 4, 0.1) << "as high as the last";
    EXPECT_EQ(keyTimes(line(), kSpeed)[1], 1);
    // What a range forbids is not reached.
    dragIn(curves, curves.placeOf({kSpeed, 0}, 0).toPoint(), QPoint(from.x() - 200, curves.height() * 20));
    EXPECT_EQ(numberOf(line(), {kSpeed, 0}, 0), 0);
}

TEST_F(TimeLinePanelTest, RangeAndRateAreFieldsAndRefuseWhatCannotBe) {
    set(windy());
    find<QDoubleSpinBox>("timeEndFrame")->setValue(45);
    EXPECT_EQ(line().end, 1.5f);
    find<QDoubleSpinBox>("timeRate")->setValue(24);
    EXPECT_EQ(line().framesPerSecond, 24);
    EXPECT_EQ(line().end, 1.5f) << "times stay";
    EXPECT_EQ(find<QDoubleSpinBox>("timeEndFrame")->value(), 36);
    find<QDoubleSpinBox>("timePreRoll")->setValue(12);
    EXPECT_EQ(line().preRoll, 12u);
    const TimeLine before = line();
    find<QDoubleSpinBox>("timeStartFrame")->setValue(40);
    EXPECT_EQ(line(), before) << "a start behind the end";
    EXPECT_FALSE(window->statusLine().message().isEmpty());
    EXPECT_EQ(find<QDoubleSpinBox>("timeStartFrame")->value(), 0);
    find<QDoubleSpinBox>("timeFrame")->setValue(12);
    EXPECT_EQ(player().lineTime(), 0.5f);
}

TEST_F(TimeLinePanelTest, ClipsAreAddedMovedTrimmedAndBlended) {
    openSampleHair("short");
    ASSERT_TRUE(player().actor());
    ASSERT_FALSE(player().actor()->clips().empty());
    const auto& clip = player().actor()->clips()[0];
    window->panel("time_line")->show();
    parts().keying.addClip(QString::fromStdString(clip.name));
    player().scrub(0.5f);
    ASSERT_TRUE(player().pose());
    EXPECT_FALSE(player().pose()->head.scalpPositions_ws.empty()) << "the clip moves the scalp";
    parts().keying.addClip(QString::fromStdString(clip.name));
    ASSERT_EQ(line().clips.size(), 2u);
    QCoreApplication::processEvents();
    const QPoint left = rows().placeOf({kClips, 1});
    dragIn(rows(), left + QPoint(14, 0), left + QPoint(14 + 40, 0));
    const float start = line().clips[1].start;
    EXPECT_GT(start, 0.5f);
    const QPoint edge = rows().placeOf({kClips, 1});
    dragIn(rows(), edge + QPoint(1, 0), edge + QPoint(21, 0));
    EXPECT_GT(line().clips[1].start, start);
    EXPECT_NEAR(line().clips[1].first, line().clips[1].start - start, 1e-4)
        << "what plays at other times stays";
    auto* blend = find<QDoubleSpinBox>("clipBlend");
    blend->setValue(0.1);
    EXPECT_NEAR(line().clips[1].blend, 0.1, 1e-6);
    find<QDoubleSpinBox>("clipSpeed")->setValue(2);
    EXPECT_EQ(line().clips[1].speed, 2);
    EXPECT_TRUE(problemsOf(line()).empty());
}

TEST_F(TimeLinePanelTest, ADoubleClickOnARowAddsAKeyThatChangesNothing) {
    TimeLine line = windy();
    keyHead(line, {0});
    HeadKey spun;
    spun.time = 2;
    spun.degrees = 720;
    keyHead(line, spun);
    set(line);
    QCoreApplication::processEvents();
    const QPoint between = (rows().placeOf({kSpeed, 1}) + rows().placeOf({kSpeed, 2})) / 2;
    const int steps = document().doneSteps();
    QTest::mouseDClick(&rows(), Qt::LeftButton, {}, between);
    EXPECT_EQ(document().doneSteps(), steps + 1);
    ASSERT_EQ(keyTimes(this->line(), kSpeed).size(), 4u);
    EXPECT_NEAR(numberOf(this->line(), {kSpeed, 2}, 0), 3, 0.1) << "half way from 2 to 4 m/s";
    const QPoint turning((rows().placeOf({kHead, 0}) + rows().placeOf({kHead, 1})) / 2);
    QTest::mouseDClick(&rows(), Qt::LeftButton, {}, turning);
    ASSERT_EQ(this->line().head.size(), 3u);
    EXPECT_NEAR(this->line().head[1].degrees, 360, 15) << "all of its turns";
    // A frame is typed as well as dragged.
    QTest::mouseClick(&rows(), Qt::LeftButton, {}, rows().placeOf({kSpeed, 2}));
    find<QDoubleSpinBox>("keyFrame")->setValue(40);
    EXPECT_NEAR(keyTimes(this->line(), kSpeed)[2], 40 / 30.0, 1e-5);
}

TEST_F(TimeLinePanelTest, UndoingAmidADragEndsIt) {
    set(windy());
    QCoreApplication::processEvents();
    const QPoint second = rows().placeOf({kSpeed, 1});
    QTest::mousePress(&rows(), Qt::LeftButton, {}, second);
    const auto moveTo = [&](const QPoint& at) {
        QMouseEvent move(QEvent::MouseMove, at, rows().mapToGlobal(at), Qt::LeftButton, Qt::LeftButton,
                         Qt::NoModifier);
        QCoreApplication::sendEvent(&rows(), &move);
    };
    moveTo(second + QPoint(20, 0));
    trigger("edit.undo");
    EXPECT_TRUE(line().isEmpty());
    moveTo(second + QPoint(40, 0));
    QTest::mouseRelease(&rows(), Qt::LeftButton, {}, second + QPoint(40, 0));
    EXPECT_TRUE(line().isEmpty());
    trigger("edit.redo");
    EXPECT_EQ(line(), windy());
}

TEST_F(TimeLinePanelTest, AClipThatIsGoneIsToldAndKept) {
    openSampleHair("short");
    TimeLine line = windy();
    line.clips = {{"somersault"}};
    set(line);
    EXPECT_TRUE(window->statusLine().message().contains("somersault"))
        << window->statusLine().message().toStdString();
    trigger("play.toggle");
    EXPECT_FALSE(player().isPlaying());
    ASSERT_TRUE(window->saveTo(inFolder("gone.hairloom")));
    trigger("file.new");
    finishWork();
    window->open(inFolder("gone.hairloom"));
    finishWork();
    EXPECT_TRUE(window->statusLine().message().contains("somersault"))
        << window->statusLine().message().toStdString();
    EXPECT_EQ(this->line(), line) << "nothing is lost";
    QCoreApplication::processEvents();
    QTest::mouseClick(&rows(), Qt::LeftButton, {}, rows().placeOf({kClips, 0}) + QPoint(20, 0));
    EXPECT_EQ(find<QComboBox>("clipName")->currentText(), "somersault");
    find<QComboBox>("clipName")->setCurrentIndex(0);
    Q_EMIT find<QComboBox>("clipName")->activated(0);
    trigger("play.toggle");
    EXPECT_TRUE(player().isPlaying());
}

TEST_F(TimeLinePanelTest, TenThousandKeysAreDrawnWithinASecond) {
    TimeLine line;
    line.end = 200;
    for (int k = 0; k < 10'000; ++k) {
        HeadKey key;
        key.time = static_cast<float>(k) / 60;
        key.degrees = static_cast<float>(k % 90);
        line.head.push_back(key);
    }
    set(line);
    QCoreApplication::processEvents();
    rows().setFocus();
    QTest::keyClick(&rows(), Qt::Key_A, Qt::ControlModifier);
    for (const bool curves : {false, true}) {
        find<QToolButton>("timeCurves")->setChecked(curves);
        QCoreApplication::processEvents();
        QWidget* const shown = curves ? static_cast<QWidget*>(find<KeyCurves>("keyCurves")) : &rows();
        const std::clock_t before = std::clock();
        shown->grab();
        EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 1) << curves;
    }
}

TEST_F(TimeLinePanelTest, NothingIsClippedWithAKeySelected) {
    TimeLine line = windy();
    keyHead(line, {0.5f});
    line.preRoll = 30;
    set(line);
    for (const QSize& size : {QSize(1280, 800), QSize(1024, 700)}) {
        window->resize(size);
        QCoreApplication::processEvents();
        const QPoint key = rows().placeOf({kHead, 0});
        QTest::mouseClick(&rows(), Qt::LeftButton, {}, key);
        QCoreApplication::processEvents();
        EXPECT_EQ(window->size(), size) << "nothing asks for more";
        ASSERT_TRUE(find<QDoubleSpinBox>("keyNumber6")->isVisibleTo(window.get()));
        expectNothingClipped(*window->panel("time_line"), "time_line");
    }
}

}  // namespace
}  // namespace hairloom::editor
