// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A window with a few strands, other programs that save, and answers to what the window asks.

#include <QAbstractButton>
#include <QApplication>
#include <QTimer>
#include <filesystem>
#include <string>

#include "core/base/file_version.h"
#include "core/documents/recovery.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"
#include "editor/shell/start_page.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {

class SavingTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        openFirstStrands(40);
        for (const RecoveryCopy& copy : recoveryCopies()) ASSERT_TRUE(removeRecoveryCopy(copy));
    }
    std::filesystem::path file(const char* name) const { return inFolder(name).toStdString(); }
    float drag() { return groom().simulation.airDrag; }
    /// A step that is not saved.
    void setDrag(float drag) {
        Groom changed = groom();
        changed.simulation.airDrag = drag;
        change("Air drag", changed);
    }
    /// As another program saves: a new file takes the name.
    void saveElsewhere(const std::filesystem::path& path, float drag) const {
        auto theirs = openProject(path);
        ASSERT_TRUE(theirs) << theirs.error().message();
        theirs->simulation.airDrag = drag;
        const std::filesystem::path beside = path.parent_path() / "theirs.hairloom";
        ASSERT_TRUE(saveProject(*theirs, beside));
        std::filesystem::rename(beside, path);
    }
    static float dragIn(const std::filesystem::path& path) {
        const auto saved = openProject(path);
        return saved ? saved->simulation.airDrag : -1;
    }
    /// Presses a button of the question that comes, and says whether one came.
    void answer(const char* button) {
        asked_ = false;
        auto* timer = new QTimer(window.get());
        QObject::connect(timer, &QTimer::timeout, window.get(), [this, timer, button] {
            const QWidget* question = QApplication::activeModalWidget();
            auto* found = question ? question->findChild<QAbstractButton*>(button) : nullptr;
            if (!found) return;
            asked_ = true;
            timer->stop();
            found->click();
        });
        timer->start(20);
    }
    /// A copy of a window that no longer runs.
    static std::filesystem::path leaveCopy(const Groom& groom, const std::filesystem::path& project) {
        auto place = RecoveryPlace::take();
        EXPECT_TRUE(place);
        EXPECT_TRUE(place->describe({project, "left", fileVersion(project), 0}));
        EXPECT_TRUE(saveProject(groom, place->copy()));
        place->keepCopy();
        return place->copy();
    }
    bool isOffered() {
        const StartPage page(files(), parts().preferences);
        return page.findChild<QPushButton*>("recover") != nullptr;
    }
    std::string said() { return window->statusLine().message().toStdString(); }

    bool asked_ = false;
};

}  // namespace hairloom::editor
