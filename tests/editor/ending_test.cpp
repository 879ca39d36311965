// SPDX-License-Identifier: GPL-3.0-or-later
// A signal ends the window in time and with a copy of what is unsaved, whatever the window does.
#ifndef _WIN32
#include <QMessageBox>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "core/documents/recovery.h"
#include "core/operations/stack.h"
#include "editor/document/end_signals.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr float kUnsavedDrag = 5;

/// Each case ends a process of its own, which says on standard error what it leaves.
class EndingDeathTest : public WindowTest {
  protected:
    void SetUp() override {
        GTEST_FLAG_SET(death_test_style, "threadsafe");
        // A shell starts what it does not wait for with some of them ignored.
        for (const int signal : {SIGTERM, SIGINT, SIGHUP}) std::signal(signal, SIG_DFL);
        WindowTest::SetUp();
        openSampleHair("short");
        openFirstStrands(40);
        ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
        Groom changed = groom();
        changed.simulation.airDrag = kUnsavedDrag;
        change("Air drag", changed);
    }
    static float dragIn(const fs::path& path) {
        const auto saved = openProject(path);
        return saved ? saved->simulation.airDrag : -1;
    }
    /// As main() does; `doing` is what the window is at when the signal comes.
    void endWhile(const std::function<void()>& doing, int signal, EndSignals::Times times = {}) {
        const fs::path copy = window->autosave().file().toStdString();
        const auto report = [copy] {
            std::fprintf(stderr, "copy with drag %g\n", static_cast<double>(dragIn(copy)));
        };
        EndSignals signals(
            [this, report] {
                window->autosave().keepFromElsewhere();
                report();
            },
            times);
        QObject::connect(&signals, &EndSignals::received, window.get(), [&] {
            window->keepUnsaved();
            window->autosave().leave();
            report();
            signals.endProcess();
        });
        QTimer::singleShot(50, window.get(), [signal] { raise(signal); });
        doing();
    }
    static void runLoop() { QEventLoop().exec(); }
};

TEST_F(EndingDeathTest, ASignalEndsTheWindowWithACopy) {
    EXPECT_EXIT(endWhile(runLoop, SIGTERM), testing::KilledBySignal(SIGTERM), "copy with drag 5");
    EXPECT_EXIT(endWhile(runLoop, SIGHUP), testing::KilledBySignal(SIGHUP), "copy with drag 5");
    // Before the program's own event loop has begun, as where a file on the command line asks.
    EXPECT_EXIT(endWhile([] { QTest::qWait(60'000); }, SIGINT), testing::KilledBySignal(SIGINT),
                "copy with drag 5");
}

TEST_F(EndingDeathTest, AnOpenDialogDoesNotPreventIt) {
    EXPECT_EXIT(endWhile([this] { QMessageBox::question(window.get(), "A", "question"); }, SIGTERM),
                testing::KilledBySignal(SIGTERM), "copy with drag 5");
}

TEST_F(EndingDeathTest, AWindowThatDoesNotAnswerIsEndedWithACopy) {
    EXPECT_EXIT(endWhile(
                    [] {
                        raise(SIGTERM);
                        std::this_thread::sleep_for(60s);
                    },
                    SIGTERM, {500ms, 1s}),
                testing::KilledBySignal(SIGTERM), "copy with drag 5");
}

TEST_F(EndingDeathTest, ACopyThatTakesTooLongEndsTheWindow) {
    EXPECT_EXIT(
        {
            EndSignals signals({}, {500ms, 500ms});
            QObject::connect(&signals, &EndSignals::received, window.get(), [] {
                std::fprintf(stderr, "begun\n");
                std::this_thread::sleep_for(60s);
            });
            QTimer::singleShot(50, window.get(), [] { raise(SIGHUP); });
            runLoop();
        },
        testing::KilledBySignal(SIGHUP), "begun");
}

TEST_F(EndingDeathTest, WhatIsBeingSavedNeedsNoCopy) {
    EXPECT_EXIT(
        {
            std::unique_lock slow(window->autosave().writing());
            EndSignals signals;
            QObject::connect(&signals, &EndSignals::received, window.get(), [&] {
                slow.unlock();
                window->keepUnsaved();
                window->autosave().leave();
                const fs::path project = inFolder("a.hairloom").toStdString();
                std::fprintf(stderr, "saved %g, %zu copies\n", static_cast<double>(dragIn(project)),
                             recoveryCopies().size());
                signals.endProcess();
            });
            QTimer::singleShot(50, window.get(), [] { raise(SIGTERM); });
            window->saveTo(inFolder("a.hairloom"));
        },
        testing::KilledBySignal(SIGTERM), "saved 5, 0 copies");
}

}  // namespace
}  // namespace hairloom::editor
#endif
