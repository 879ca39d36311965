// SPDX-License-Identifier: GPL-3.0-or-later
// No work is lost or overwritten: other programs and windows on the same project, crashes, ends of sessions,
// folders that take no copy.
#include <QDir>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QTimer>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <thread>

#include "core/base/file.h"
#include "core/base/write_rules.h"
#include "core/documents/recovery.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"
#include "editor/document/end_signals.h"
#include "editor/shell/start_page.h"
#include "tests/editor/saving_fixture.h"

#ifndef _WIN32
#include <sys/stat.h>
#endif

namespace hairloom::editor {
namespace {

namespace fs = std::filesystem;

TEST_F(SavingTest, WhatAnotherProgramSavedIsNotOverwrittenUnasked) {
    const fs::path path = file("a.hairloom");
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    setDrag(5);
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom"))) << "own savings are no question";
    saveElsewhere(path, 7);
    setDrag(9);
    answer("changedCancel");
    EXPECT_FALSE(window->saveTo(inFolder("a.hairloom")));
    EXPECT_TRUE(asked_);
    EXPECT_EQ(dragIn(path), 7);
    EXPECT_TRUE(window->isWindowModified());
    answer("changedOverwrite");
    EXPECT_TRUE(window->saveTo(inFolder("a.hairloom")));
    EXPECT_TRUE(asked_);
    EXPECT_EQ(dragIn(path), 9);
    EXPECT_FALSE(window->isWindowModified());
}

TEST_F(SavingTest, SaveIncrementalTakesTheNextVersion) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    setDrag(5);
    trigger("file.saveIncremental");
    EXPECT_EQ(document().title().toStdString(), "a_v001.hairloom");
    EXPECT_NE(dragIn(file("a.hairloom")), 5) << "the version before stays as it was";
    EXPECT_EQ(dragIn(file("a_v001.hairloom")), 5);
    fs::copy_file(file("a.hairloom"), file("a_v007.hairloom"));
    trigger("file.saveIncremental");
    EXPECT_TRUE(fs::exists(file("a_v008.hairloom")));
    EXPECT_NE(dragIn(file("a_v007.hairloom")), 5);
}

TEST_F(SavingTest, TheirsCanBeReloadedAndOursSavedElsewhere) {
    const fs::path path = file("a.hairloom");
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    files().open(inFolder("a.hairloom"));
    finishWork();
    setDrag(3);
    saveElsewhere(path, 7);
    answer("changedReload");
    EXPECT_FALSE(window->saveTo(inFolder("a.hairloom")));
    finishWork();
    EXPECT_EQ(drag(), 7);
    EXPECT_FALSE(window->isWindowModified());
    setDrag(4);
    EXPECT_TRUE(window->saveTo(inFolder("a.hairloom"))) << said();
    saveElsewhere(path, 8);
    setDrag(6);
    answer("changedSaveAs");
    onceAskedForAFile(inFolder("b.hairloom"));
    window->saveTo(inFolder("a.hairloom"));
    EXPECT_EQ(dragIn(path), 8);
    EXPECT_EQ(dragIn(file("b.hairloom")), 6);
    EXPECT_EQ(document().path(), inFolder("b.hairloom"));
}

TEST_F(SavingTest, AChangeInPlaceIsSeenAndTheWindowSaysSoWhenItIsLookedAt) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    auto theirs = openProject(file("a.hairloom"));
    ASSERT_TRUE(theirs);
    theirs->simulation.airDrag = 7;
    ASSERT_TRUE(saveProject(*theirs, file("theirs.hairloom")));
    fs::copy_file(file("theirs.hairloom"), file("a.hairloom"), fs::copy_options::overwrite_existing);
    QEvent event(QEvent::ActivationChange);
    window->activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
    QCoreApplication::sendEvent(window.get(), &event);
    EXPECT_NE(said().find("was saved by another program or window"), std::string::npos) << said();
    trigger("file.revert");
    finishWork();
    EXPECT_EQ(drag(), 7);
}

TEST_F(SavingTest, WhatWasReadIsNoTargetOfAnExport) {
    std::ofstream(file("notes.txt")) << "mine";
    ASSERT_TRUE(readTextFile(file("notes.txt")));
    const auto status = writeFileAtomically(file("notes.txt"), std::string_view("theirs"));
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message().find("is an input file"), std::string::npos);
}

#ifndef _WIN32
TEST_F(SavingTest, LinksAndModesStay) {
    fs::create_directories(file("store"));
    ASSERT_TRUE(window->saveTo(inFolder("store/a.hairloom")));
    fs::create_symlink("store/a.hairloom", file("link.hairloom"));
    ASSERT_EQ(chmod(file("store/a.hairloom").c_str(), 0640), 0);
    files().open(inFolder("link.hairloom"));
    finishWork();
    setDrag(5);
    ASSERT_TRUE(window->saveTo(document().path())) << said();
    EXPECT_TRUE(fs::is_symlink(file("link.hairloom")));
    EXPECT_EQ(dragIn(file("store/a.hairloom")), 5);
    struct stat info {};
    ASSERT_EQ(stat(file("store/a.hairloom").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0640u);
}

TEST_F(SavingTest, TheSystemsWordToEndLeavesACopy) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    for (const int signal : {SIGTERM, SIGHUP}) {
        setDrag(signal == SIGTERM ? 5 : 6);
        const auto unsaved = hash();
        {
            const EndSignals signals;
            int ended = 0;
            QObject::connect(&signals, &EndSignals::received, window.get(), [&] {
                window->keepUnsaved();
                ++ended;
            });
            raise(signal);
            ASSERT_TRUE(QTest::qWaitFor([&] { return ended > 0; }, kPatience));
            EXPECT_EQ(signals.last(), signal);
        }
        window.reset();
        const auto copies = recoveryCopies();
        ASSERT_EQ(copies.size(), 1u);
        const auto copy = openProject(copies[0].file);
        ASSERT_TRUE(copy) << copy.error().message();
        EXPECT_EQ(contentHash(*copy), unsaved);
        EXPECT_EQ(copies[0].of.project, file("a.hairloom"));
        EXPECT_FALSE(copies[0].isOlder);
        ASSERT_TRUE(removeRecoveryCopy(copies[0]));
        open();
        files().open(inFolder("a.hairloom"));
        finishWork();
    }
}
#endif

TEST_F(SavingTest, SavingTakesTheCopyAwayAndAnOlderOneIsNotOffered) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    setDrag(5);
    window->autosave().saveNow();
    window->autosave().finish();
    const QString copy = window->autosave().file();
    EXPECT_TRUE(QFile::exists(copy));
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    EXPECT_FALSE(QFile::exists(copy));
    // A window was killed between saving and taking its copy away.
    const fs::path left = leaveCopy(groom(), file("a.hairloom"));
    ASSERT_EQ(recoveryCopies().size(), 1u);
    EXPECT_FALSE(recoveryCopies()[0].isOlder);
    EXPECT_TRUE(isOffered());
    saveElsewhere(file("a.hairloom"), 6);
    fs::last_write_time(left, fs::last_write_time(file("a.hairloom")) - std::chrono::seconds(5));
    ASSERT_EQ(recoveryCopies().size(), 1u);
    EXPECT_TRUE(recoveryCopies()[0].isOlder);
    EXPECT_FALSE(isOffered());
    ASSERT_TRUE(removeRecoveryCopy(recoveryCopies()[0]));
}

TEST_F(SavingTest, OpeningTheProjectWhoseCopyWaitsAsks) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    Groom unsaved = groom();
    unsaved.simulation.airDrag = 5;
    leaveCopy(unsaved, file("a.hairloom"));
    trigger("file.new");
    answer("waitingCancel");
    files().open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_TRUE(asked_);
    EXPECT_TRUE(document().isEmpty());
    answer("waitingOpen");
    files().open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_TRUE(asked_);
    EXPECT_NE(drag(), 5);
    EXPECT_EQ(recoveryCopies().size(), 1u);
    answer("waitingRecover");
    files().open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_TRUE(asked_);
    EXPECT_EQ(drag(), 5);
    EXPECT_TRUE(window->isWindowModified());
    ASSERT_TRUE(window->saveTo(document().path())) << said();
    EXPECT_EQ(dragIn(file("a.hairloom")), 5);
    EXPECT_TRUE(recoveryCopies().empty());
}

TEST_F(SavingTest, ARecoveredProjectDoesNotOverwriteWhatWasSavedSince) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    leaveCopy(groom(), file("a.hairloom"));
    saveElsewhere(file("a.hairloom"), 7);
    fs::last_write_time(file("a.hairloom"),
                        fs::last_write_time(file("a.hairloom")) - std::chrono::minutes(1));
    ASSERT_EQ(recoveryCopies().size(), 1u);
    EXPECT_TRUE(recoveryCopies()[0].isProjectChanged);
    files().openRecovered(recoveryCopies()[0]);
    finishWork();
    answer("changedCancel");
    EXPECT_FALSE(window->saveTo(document().path()));
    EXPECT_TRUE(asked_);
    EXPECT_EQ(dragIn(file("a.hairloom")), 7);
    ASSERT_TRUE(removeRecoveryCopy(recoveryCopies()[0]));
}

TEST_F(SavingTest, ProjectsKeepTheirPlaceWhereverTheProgramStands) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    const QString before = QDir::currentPath();
    QDir::setCurrent(folder.path());
    files().open("a.hairloom");
    finishWork();
    fs::create_directories(file("other"));
    QDir::setCurrent(inFolder("other"));
    EXPECT_EQ(document().path(), inFolder("a.hairloom"));
    setDrag(5);
    EXPECT_TRUE(window->saveTo(document().path()));
    EXPECT_EQ(dragIn(file("a.hairloom")), 5);
    EXPECT_TRUE(fs::is_empty(file("other")));
    // A note with a relative place is worth none.
    const fs::path copy = leaveCopy(groom(), "a.hairloom");
    ASSERT_EQ(recoveryCopies().size(), 1u);
    EXPECT_TRUE(recoveryCopies()[0].of.project.empty());
    files().openRecovered(recoveryCopies()[0]);
    finishWork();
    EXPECT_TRUE(document().path().isEmpty());
    QDir::setCurrent(before);
    ASSERT_TRUE(removeRecoveryCopy(recoveryCopies()[0]));
}

TEST_F(SavingTest, TwoWindowsOnOneProjectKnowOfEachOther) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    trigger("file.new");
    auto other = RecoveryPlace::take();
    ASSERT_TRUE(other);
    ASSERT_TRUE(other->describe({file("a.hairloom"), "a", {}, 0}));
    answer("elsewhereCancel");
    files().open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_TRUE(asked_);
    EXPECT_TRUE(document().isEmpty());
    answer("elsewhereCopy");
    files().open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_FALSE(document().isEmpty());
    EXPECT_TRUE(document().path().isEmpty());
    answer("replaceCancel");
    EXPECT_FALSE(window->saveTo(inFolder("a.hairloom")));
    EXPECT_TRUE(asked_);
    answer("elsewhereOpen");
    files().open(inFolder("a.hairloom"));
    finishWork();
    EXPECT_EQ(document().path(), inFolder("a.hairloom"));
    EXPECT_EQ(other->othersWith(file("a.hairloom")).size(), 1u) << "the other one knows, too";
    trigger("file.new");
    EXPECT_TRUE(other->othersWith(file("a.hairloom")).empty());
}

TEST_F(SavingTest, ACopyThatCannotBeWrittenIsToldAndTriedAgain) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    const fs::path place = recoveryFolder();
    const fs::path aside = place.parent_path() / "aside";
    fs::rename(place, aside);
    std::ofstream(place) << "in the way";
    setDrag(5);
    window->autosave().saveNow();
    window->autosave().finish();
    const std::string standing = window->statusLine().standing().toStdString();
    EXPECT_NE(standing.find(place.string()), std::string::npos) << standing;
    parts().messages.say("something else");
    EXPECT_FALSE(window->statusLine().standing().isEmpty()) << "it stays";
    fs::remove(place);
    fs::rename(aside, place);
    EXPECT_TRUE(QTest::qWaitFor([&] { return window->statusLine().standing().isEmpty(); }, kPatience));
    EXPECT_EQ(dragIn(window->autosave().file().toStdString()), 5);
}

TEST_F(SavingTest, AtMostAMinuteOfWorkIsLostByDefault) {
    EXPECT_EQ(parts().preferences.autosaveMinutes(), 1);
    setDrag(5);
    auto* timer = window->autosave().findChild<QTimer*>();
    ASSERT_TRUE(timer);
    ASSERT_TRUE(QTest::qWaitFor([&] { return timer->isActive(); }, kPatience));
    EXPECT_LT(timer->interval(), 57'000) << "ms, which leaves time to write the copy";
    timer->start(0);  // the minute is over
    EXPECT_TRUE(QTest::qWaitFor([&] { return QFile::exists(window->autosave().file()); }, kPatience));
}

TEST_F(SavingTest, TheWindowLivesWhileItSaves) {
    // As on a disk that takes its time.
    std::unique_lock slow(window->autosave().writing());
    int ticks = 0;
    QTimer tick;
    QObject::connect(&tick, &QTimer::timeout, [&] {
        if (++ticks == 10) slow.unlock();
    });
    tick.start(10);
    EXPECT_TRUE(window->saveTo(inFolder("a.hairloom")));
    EXPECT_GE(ticks, 10);
}

TEST_F(SavingTest, WhatAKillLeavesInTheFolderOfCopiesIsFound) {
    const fs::path place = recoveryFolder();
    fs::create_directories(place);
    std::ofstream(place / ".0123.hairloom.0123456789abc.hairloom-part") << "half";
    std::ofstream(place / "0123.window");
    std::ofstream(place / "0123.json") << "{}";
    EXPECT_TRUE(recoveryCopies().empty());
    EXPECT_FALSE(fs::exists(place / "0123.window"));
    EXPECT_FALSE(fs::exists(place / "0123.json"));
    StartPage page(files(), parts().preferences);
    auto* remove = page.findChild<QPushButton*>("removeLeftOver");
    ASSERT_TRUE(remove);
    remove->click();
    EXPECT_FALSE(fs::exists(place / ".0123.hairloom.0123456789abc.hairloom-part"));
}

TEST_F(SavingTest, FilesOfTheWorkingFolderAreNoCopies) {
    const QString before = QDir::currentPath();
    QDir::setCurrent(folder.path());
    for (const char* name : {".hairloom", ".json", ".window"}) std::ofstream(file(name)) << "mine";
    { const auto place = RecoveryPlace::take(); }
    window.reset();
    open();
    for (const char* name : {".hairloom", ".json", ".window"}) EXPECT_TRUE(fs::exists(file(name))) << name;
    QDir::setCurrent(before);
}

TEST_F(SavingTest, TheWindowSaysWhatGuardsForeignFiles) {
    trigger("help.security");
    finishWork();
    auto* box = window->findChild<QMessageBox*>("security");
    ASSERT_TRUE(box);
    EXPECT_TRUE(box->informativeText().contains("Layer “System calls”"))
        << box->informativeText().toStdString();
    EXPECT_TRUE(box->informativeText().contains("Network: ")) << box->informativeText().toStdString();
    box->close();
}

TEST_F(SavingTest, WorkDoneWhileAnotherFileIsReadIsNotDropped) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    window->setUnsavedAnswer(MainWindow::Unsaved::Keep);
    files().openSample({});
    setDrag(5);
    finishWork();
    EXPECT_EQ(drag(), 5);
    EXPECT_EQ(groom().strandCount(), 40u);
}

/// How often the loop of events comes round while `doing` runs.
int turnsWhile(const std::function<void()>& doing) {
    int turns = 0;
    QTimer ticks;
    QObject::connect(&ticks, &QTimer::timeout, &ticks, [&] { ++turns; });
    ticks.start(0);
    doing();
    return turns;
}

TEST_F(SavingTest, TheViewGoesOnWhileALargeGroomIsSavedAndCopied) {
    constexpr std::uint32_t kStrands = 100'000, kPoints = 16;
    std::vector<std::uint32_t> offsets(kStrands + 1);
    std::vector<Vec3f> positions(std::size_t{kStrands} * kPoints);
    for (std::size_t s = 0; s <= kStrands; ++s) offsets[s] = static_cast<std::uint32_t>(s * kPoints);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto s = static_cast<float>(i / kPoints);
        positions[i] = {0.1f * std::sin(s), 0.01f * static_cast<float>(i % kPoints), 0.1f * std::cos(s)};
    }
    document().open(makeGroom(std::move(offsets), std::move(positions)), {}, "large");
    setDrag(3);
    window->autosave().saveNow();
    const auto copied = [&] { return fs::exists(window->autosave().file().toStdString()); };
    EXPECT_TRUE(QTest::qWaitFor(copied, kPatience));
    EXPECT_GT(turnsWhile([&] { EXPECT_TRUE(window->saveTo(inFolder("l.hairloom"))); }), 0);
    EXPECT_GT(fs::file_size(file("l.hairloom")), 10'000'000u);
}

}  // namespace
}  // namespace hairloom::editor
