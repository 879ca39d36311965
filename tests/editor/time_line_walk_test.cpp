// SPDX-License-Identifier: GPL-3.0-or-later
// An animator's walk: a character with a clip, keyed wind, a take that is recorded, scrubbed backwards and
// exported, the same hair from the command line, and all of it again after the project is opened anew.

#include <gtest/gtest.h>

#include <QComboBox>
#include <QLineEdit>
#include <QMenu>
#include <QProcess>
#include <QPushButton>
#include <QSpinBox>

#include "core/animation/actor.h"
#include "core/documents/takes.h"
#include "core/groom/time_line_keys.h"
#include "core/simulation/frame_record.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/fields/number_box.h"
#include "importers/strands.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class TimeLineWalkTest : public WindowTest {
  protected:
    Player& player() { return parts().player; }
    const TimeLine& line() { return timeLineOf(groom()); }
    /// An entry of the panel's menu Key, or of a menu in it.
    void chooseKey(const QString& words, const QString& in = {}) {
        auto* menu = find<QMenu>("timeKeyMenu");
        Q_EMIT menu->aboutToShow();
        QMenu* from = menu;
        for (QAction* action : menu->actions()) {
            if (!in.isEmpty() && action->menu() && action->text() == in) from = action->menu();
        }
        for (QAction* action : from->actions()) {
            if (action->text().startsWith(words)) return action->trigger();
        }
        ADD_FAILURE() << "nothing offers " << words.toStdString();
    }
    std::filesystem::path project() { return inFolder("walk.hairloom").toStdString(); }
};

TEST_F(TimeLineWalkTest, KeyRecordScrubBackAndExport) {
    openSampleHair("short");
    ASSERT_TRUE(player().actor());
    const QString clip = QString::fromStdString(player().actor()->clips().front().name);
    ASSERT_TRUE(window->saveTo(inFolder("walk.hairloom")));
    window->panel("time_line")->show();
    // Thirty frames at 30 a second of the clip, in wind that rises.
    find<QDoubleSpinBox>("timeRate")->setValue(30);
    find<QDoubleSpinBox>("timeEndFrame")->setValue(12);
    find<QDoubleSpinBox>("timePreRoll")->setValue(3);
    find<QAbstractButton>("timeLoop")->click();
    ASSERT_FALSE(line().loop);
    player().scrub(0);
    chooseKey(clip, "Add clip");
    auto* speed = window->panel("physics")->findChild<NumberBox*>("windSpeed");
    ASSERT_TRUE(speed);
    for (const auto& [frame, value] : {std::pair{0, 0.0}, {12, 9.0}}) {
        find<QDoubleSpinBox>("timeFrame")->setValue(frame);
        player().scrub(static_cast<float>(frame) / 30);
        Groom windier = groom();
        windier.simulation.windSpeed = static_cast<float>(value);
        change("Wind speed", windier);
        chooseKey("Wind speed", "Setting of Physics");
    }
    ASSERT_EQ(line().clips.size(), 1u);
    ASSERT_EQ(line().settings.size(), 1u);
    ASSERT_EQ(line().settings[0].keys.size(), 2u);
    EXPECT_EQ(player().motion(), "timeline");
    // Record: from the start, whatever is shown.
    player().scrub(0.3f);
    window->panel("takes")->raise();
    find<QLineEdit>("takeName")->setText("gust");
    find<QPushButton>("takeRecord")->click();
    ASSERT_TRUE(QTest::qWaitFor([&] { return !player().isPlaying(); }, kPatience));
    find<QPushButton>("takeRecord")->click();
    const auto path = takePath(project(), "gust");
    ASSERT_TRUE(path);
    auto take = TakeReader::open(*path);
    ASSERT_TRUE(take) << take.error().message();
    EXPECT_EQ(take->info().frames, 12u);
    EXPECT_EQ(take->info().framesPerSecond, 30);
    ASSERT_TRUE(take->use(groom()));
    // Scrub backwards by the key: each frame is the take's.
    player().scrub(line().end);
    std::vector<Vec3f> before;
    for (std::uint64_t number = 12; number > 1; --number) {
        ASSERT_TRUE(viewport().pose());
        const auto& shown = viewport().pose()->positions_ws;
        EXPECT_EQ(shown, take->frame(number - 1)->positions_ws) << number;
        EXPECT_NE(shown, before) << number;
        before = shown;
        trigger("play.stepBack");
    }
    // Export it: animated Alembic, read by the Alembic library.
    ExportDialog exports(document(), parts().preferences, parts().tasks, parts().messages, player());
    exports.show();
    exports.findChild<QComboBox*>("target")->setCurrentText("Houdini");
    exports.findChild<QComboBox*>("format")->setCurrentText("Alembic .abc");
    exports.findChild<QSpinBox*>("frames")->setValue(13);
    EXPECT_EQ(exports.findChild<QDoubleSpinBox*>("frameRate")->value(), 30) << "the time line's";
    EXPECT_EQ(exports.findChild<QSpinBox*>("preRoll")->value(), 3);
    exports.exportTo(inFolder("gust.abc"));
    finishWork();
    StrandImportOptions asked;
    asked.frames = true;
    const auto read = importStrands(inFolder("gust.abc").toStdString(), asked);
    ASSERT_TRUE(read) << read.error().message() << window->statusLine().message().toStdString();
    EXPECT_EQ(read->framesPerSecond, 30);
    ASSERT_EQ(read->frames.size(), 13u);
    ASSERT_EQ(read->frames[12].size(), groom().pointCount());
    // Its frame 12 is the take's last: the same simulation, in half a tenth of a millimetre.
    const auto last = take->frame(11)->positions_ws;
    float farthest = 0;
    for (std::size_t p = 0; p < last.size(); ++p)
        farthest = std::max(farthest, (read->frames[12][p] - last[p]).norm());
    EXPECT_LT(farthest, 2e-4f);
    // All of it is in the project.
    const TimeLine authored = line();
    ASSERT_TRUE(window->saveTo(inFolder("walk.hairloom")));
    // The command line plays the very hair that the window played.
    QProcess command;
    command.start(HAIRLOOM_CLI, {"simulate", inFolder("walk.hairloom"), "--motion", "timeline", "--record",
                                 inFolder("walk.frames")});
    ASSERT_TRUE(command.waitForFinished(kPatience));
    ASSERT_EQ(command.exitCode(), 0) << command.readAllStandardError().toStdString();
    for (std::int64_t frame = 1; frame <= 12; ++frame) {
        const auto played = player().frameCache().at(frame);
        ASSERT_TRUE(played) << frame;
        const auto simulated =
            readFrame(inFolder("walk.frames").toStdString(), groom(), static_cast<std::uint64_t>(frame - 1));
        ASSERT_TRUE(simulated) << simulated.error().message();
        EXPECT_EQ(played->positions_ws, simulated->positions_ws) << "bit for bit, frame " << frame;
    }
    trigger("file.new");
    finishWork();
    window->open(inFolder("walk.hairloom"));
    finishWork();
    EXPECT_EQ(line(), authored);
    EXPECT_EQ(player().motion(), "timeline");
    EXPECT_TRUE(window->panel("time_line")->isVisible());
}

}  // namespace
}  // namespace hairloom::editor
