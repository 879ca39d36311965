// SPDX-License-Identifier: GPL-3.0-or-later
// The project's time line in the window: from a file, played, undone, and to a file.

#include <gtest/gtest.h>

#include <QComboBox>
#include <QFile>
#include <QThread>
#include <fstream>

#include "core/animation/actor.h"
#include "core/documents/keyed_motion.h"
#include "core/groom/file/time_line_json.h"
#include "core/groom/time_line.h"
#include "editor/simulation/player.h"
#include "tests/editor/window_fixture.h"
#include "tests/support/talking_skin.h"

namespace hairloom::editor {
namespace {

class TimeLineTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        openFirstStrands(20);
    }
    /// A fifth of a second at 30 frames a second, with wind and a turn of the head.
    static TimeLine line() {
        TimeLine line;
        line.framesPerSecond = 30;
        line.end = 0.2f;
        line.loop = false;
        line.preRoll = 2;
        line.head = {{0}, {0.2f}};
        line.head[1].degrees = 30;
        SettingTrack track{"simulation.windSpeed", {{0}, {0.2f}}};
        track.keys[1].value.x() = 8;
        line.settings = {track};
        return line;
    }
    QString fileOf(const TimeLine& line) {
        const QString path = inFolder("line.json");
        std::ofstream(path.toStdString()) << timeLineText(line);
        return path;
    }
    Player& player() { return parts().player; }
    QComboBox* motions() { return window->findChild<QComboBox*>("motion"); }
};

TEST_F(TimeLineTest, PlaysAtItsRateToItsEndAndIsUndone) {
    ASSERT_TRUE(motions());
    EXPECT_LT(motions()->findText("Time line"), 0) << "there is none yet";
    ASSERT_TRUE(window->openTimeLine(fileOf(line())));
    EXPECT_EQ(player().motion(), "timeline") << "what is opened plays";
    EXPECT_EQ(motions()->currentText(), "Time line");
    std::vector<double> times;
    QObject::connect(&player(), &Player::frameReady, window.get(), [&] {
        if (player().frame()) times.push_back(player().frame()->time);
    });
    trigger("play.toggle");
    ASSERT_TRUE(player().isPlaying());
    // A window that is busy meanwhile changes nothing.
    QThread::sleep(1);
    ASSERT_TRUE(QTest::qWaitFor([&] { return !player().isPlaying(); }, kPatience));
    ASSERT_GE(times.size(), 1u);
    EXPECT_NEAR(times.back(), 0.2, 1e-3) << "it stops at its end";
    for (const double time : times)
        EXPECT_NEAR(time * 30, std::round(time * 30), 1e-3) << "frames of a thirtieth of a second";
    EXPECT_EQ(document().groom().simulation.windSpeed, runtime::SimulationSettings().windSpeed)
        << "keys leave the authored setting as it is";
    trigger("edit.undo");
    EXPECT_EQ(player().motion(), "none");
    EXPECT_LT(motions()->findText("Time line"), 0);
    trigger("edit.redo");
    EXPECT_EQ(player().motion(), "timeline");
    EXPECT_EQ(timeLineOf(document().groom()), line());
    trigger("timeLine.clear");
    EXPECT_TRUE(timeLineOf(document().groom()).isEmpty());
    // What played before the first key comes back with its undo.
    ASSERT_TRUE(player().setMotion("nod"));
    ASSERT_TRUE(window->openTimeLine(fileOf(line())));
    EXPECT_EQ(player().motion(), "timeline");
    trigger("edit.undo");
    EXPECT_EQ(player().motion(), "nod");
    trigger("edit.redo");
    EXPECT_EQ(player().motion(), "timeline");
}

TEST_F(TimeLineTest, IsSavedAndOpenedAgainAndTakesKeyframeFiles) {
    ASSERT_TRUE(window->openTimeLine(fileOf(line())));
    ASSERT_TRUE(window->saveTimeLine(inFolder("kept.json")));
    trigger("timeLine.clear");
    ASSERT_TRUE(window->openTimeLine(inFolder("kept.json")));
    EXPECT_EQ(timeLineOf(document().groom()), line());
    TimeLine other;
    other.wind = {{0}, {1}};
    other.wind[1].velocity.x() = 5;
    std::ofstream(inFolder("keys.json").toStdString()) << motionText(other);
    ASSERT_TRUE(window->openTimeLine(inFolder("keys.json")));
    const TimeLine& now = timeLineOf(document().groom());
    EXPECT_EQ(now.wind, other.wind);
    EXPECT_NE(now.head, line().head) << "a keyframe file says all of head and wind";
    EXPECT_EQ(now.settings, line().settings) << "and nothing of settings";
    ASSERT_TRUE(window->saveMotion(inFolder("kept-keys.json")));
    EXPECT_TRUE(window->statusLine().message().contains("without clips and settings"));
    const auto kept = loadMotionKeys(inFolder("kept-keys.json").toStdString());
    ASSERT_TRUE(kept) << kept.error().message();
    EXPECT_EQ(kept->wind, now.wind);
    trigger("timeLine.clear");
    EXPECT_FALSE(window->saveMotion(inFolder("none.json"))) << "there are no keys";
}

TEST_F(TimeLineTest, WhatCannotPlayIsNotTaken) {
    ASSERT_TRUE(window->openTimeLine(fileOf(line())));
    TimeLine missing = line();
    missing.clips = {{"somersault"}};
    EXPECT_FALSE(window->openTimeLine(fileOf(missing)));
    EXPECT_TRUE(window->statusLine().message().contains("no animation clips"))
        << window->statusLine().message().toStdString();
    std::ofstream(inFolder("line.json").toStdString()) << "{\"time_line\": {\"frames_per_second\": -1}}";
    EXPECT_FALSE(window->openTimeLine(inFolder("line.json")));
    EXPECT_FALSE(window->openTimeLine(inFolder("nothing.json")));
    EXPECT_EQ(timeLineOf(document().groom()), line()) << "nothing is lost";
}

TEST_F(TimeLineTest, AFaceTalksWhereverTheLineIsScrubbedAndAfterTheProjectIsOpenedAgain) {
    const QString head = inFolder("talking.glb");
    {
        QFile file(head);
        ASSERT_TRUE(file.open(QIODevice::WriteOnly));
        file.write(
            QByteArray::fromStdString(test::talkingBust((samplesFolder() / "bust/bust.glb").string())));
    }
    window->open(head);
    finishWork();
    parts().keying.addClip("talk");
    const auto expectTalking = [&](float time) {
        player().scrub(time);
        ASSERT_TRUE(player().pose());
        const auto& posed = player().pose()->head.scalpPositions_ws;
        ASSERT_EQ(posed.size(), groom().scalp->vertexCount());
        double farthest = 0, off = 0;
        for (std::size_t v = 0; v < posed.size(); ++v) {
            const Vec3d rest = groom().scalp->positions()[v].cast<double>();
            const double weight = test::weightOf(*player().actor(), v, "head");
            const test::FaceAt now = test::talkAt(static_cast<double>(time));
            off = std::max(off, (posed[v].cast<double>() - test::skinAt(rest, weight, now)).norm());
            farthest = std::max(
                farthest, (posed[v].cast<double>() - test::skinAt(rest, weight, {0, 0, now.radians})).norm());
        }
        EXPECT_LT(off, 2e-5) << time;
        EXPECT_GT(farthest, 0.004) << time;
    };
    for (const float time : {0.75f, 0.25f, 0.5f}) expectTalking(time);
    ASSERT_TRUE(window->saveTo(inFolder("talking.hairloom")));
    trigger("file.new");
    window->open(inFolder("talking.hairloom"));
    finishWork();
    expectTalking(0.25f);
}

}  // namespace
}  // namespace hairloom::editor
