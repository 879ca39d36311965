// SPDX-License-Identifier: GPL-3.0-or-later
// What is odd about the place that a project is saved to: other things under its name, folders that went,
// disks that take nothing.
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/file.h"
#include "tests/editor/saving_fixture.h"

#ifndef _WIN32
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace hairloom::editor {
namespace {

namespace fs = std::filesystem;

#ifndef _WIN32

/// Reads from a FIFO that somebody waits for, after ten seconds, and says so.
class PatientReader {
  public:
    explicit PatientReader(fs::path fifo) : fifo_(std::move(fifo)), thread_([this] { run(); }) {}
    /// Whether it had to.
    bool end() {
        isOver_ = true;
        thread_.join();
        return hasRead_;
    }

  private:
    void run() {
        using namespace std::chrono_literals;
        for (int i = 0; i < 200 && !isOver_; ++i) std::this_thread::sleep_for(50ms);
        if (isOver_) return;
        hasRead_ = true;
        const int fifo = ::open(fifo_.c_str(), O_RDONLY | O_NONBLOCK);
        while (!isOver_) std::this_thread::sleep_for(10ms);
        if (fifo >= 0) ::close(fifo);
    }

    fs::path fifo_;
    std::atomic<bool> isOver_ = false, hasRead_ = false;
    std::thread thread_;
};

TEST_F(SavingTest, WhatTookTheProjectsNameIsNotWrittenInto) {
    const fs::path path = file("a.hairloom");
    const std::vector<std::pair<const char*, std::function<void()>>> takers{
        {"a FIFO", [&] { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0); }},
        {"a folder", [&] { fs::create_directory(path); }},
        {"a device", [&] { fs::create_symlink("/dev/null", path); }},
        {"a link to nowhere", [&] { fs::create_symlink("nowhere/b.hairloom", path); }},
        {"a link to itself", [&] { fs::create_symlink("a.hairloom", path); }},
    };
    float next = 3;
    for (const auto& [what, take] : takers) {
        ASSERT_TRUE(window->saveTo(inFolder("a.hairloom"))) << said();
        setDrag(next += 0.5f);
        fs::remove(path);
        take();
        const auto kind = fs::symlink_status(path).type();
        PatientReader reader(path);
        answer("changedOverwrite");
        EXPECT_FALSE(window->saveTo(inFolder("a.hairloom"))) << what;
        EXPECT_FALSE(reader.end()) << what;
        EXPECT_TRUE(window->isWindowModified()) << what;
        EXPECT_NE(said().find("a.hairloom"), std::string::npos) << what << ": " << said();
        EXPECT_EQ(fs::symlink_status(path).type(), kind) << what;
        fs::remove(path);
        answer("changedOverwrite");
        EXPECT_TRUE(window->saveTo(inFolder("a.hairloom"))) << what << ": " << said();
        EXPECT_EQ(dragIn(path), drag()) << what;
    }
}

TEST_F(SavingTest, ALimitOfFileSizesIsToldAndNothingIsLost) {
    const fs::path path = file("a.hairloom");
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    const float before = drag();
    setDrag(5);
    // As the editor's main() does.
    const auto asBefore = std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const rlimit little{4096, limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
    EXPECT_FALSE(window->saveTo(inFolder("a.hairloom")));
    const std::string why = said();
    window->autosave().saveNow();
    window->autosave().finish();
    const bool isTold = !window->statusLine().standing().isEmpty();
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    std::signal(SIGXFSZ, asBefore);
    EXPECT_NE(why.find("a.hairloom"), std::string::npos) << why;
    EXPECT_TRUE(isTold);
    EXPECT_TRUE(window->isWindowModified());
    EXPECT_EQ(dragIn(path), before);
    EXPECT_TRUE(QTest::qWaitFor([&] { return window->statusLine().standing().isEmpty(); }, kPatience));
    EXPECT_TRUE(window->saveTo(inFolder("a.hairloom"))) << said();
    EXPECT_EQ(dragIn(path), 5);
}

#endif

TEST_F(SavingTest, AProjectWhoseFolderWentIsSavedElsewhere) {
    fs::create_directories(file("job"));
    ASSERT_TRUE(window->saveTo(inFolder("job/a.hairloom")));
    setDrag(5);
    fs::rename(file("job"), file("moved"));
    answer("changedOverwrite");
    EXPECT_FALSE(window->saveTo(inFolder("job/a.hairloom")));
    EXPECT_NE(said().find("job"), std::string::npos) << said();
    EXPECT_FALSE(fs::exists(file("job")));
    EXPECT_TRUE(window->isWindowModified());
    EXPECT_TRUE(window->saveTo(inFolder("moved/b.hairloom"))) << said();
    EXPECT_EQ(dragIn(file("moved/b.hairloom")), 5);
    EXPECT_NE(dragIn(file("moved/a.hairloom")), 5);
}

TEST_F(SavingTest, ACopyWhoseProjectMovedIsOfferedAndSavedWhereAsked) {
    fs::create_directories(file("job"));
    ASSERT_TRUE(window->saveTo(inFolder("job/a.hairloom")));
    Groom changed = groom();
    changed.simulation.airDrag = 6;
    leaveCopy(changed, file("job/a.hairloom"));
    trigger("file.new");
    fs::rename(file("job"), file("moved"));
    const auto copies = recoveryCopies();
    ASSERT_EQ(copies.size(), 1u);
    EXPECT_FALSE(copies[0].isOlder);
    EXPECT_TRUE(isOffered());
    files().openRecovered(copies[0]);
    finishWork();
    EXPECT_EQ(drag(), 6);
    EXPECT_TRUE(window->isWindowModified());
    answer("changedOverwrite");
    EXPECT_FALSE(window->saveTo(inFolder("job/a.hairloom")));
    EXPECT_EQ(recoveryCopies().size() + (fs::exists(window->autosave().file().toStdString()) ? 1u : 0u), 1u)
        << "the work is still in one copy";
    EXPECT_TRUE(window->saveTo(inFolder("moved/b.hairloom"))) << said();
    EXPECT_EQ(dragIn(file("moved/b.hairloom")), 6);
}

TEST_F(SavingTest, ReloadingWhatIsDamagedKeepsWhatIsOpen) {
    ASSERT_TRUE(window->saveTo(inFolder("a.hairloom")));
    setDrag(5);
    std::ofstream(file("theirs")) << "half a project";
    fs::rename(file("theirs"), file("a.hairloom"));
    answer("changedReload");
    EXPECT_FALSE(window->saveTo(inFolder("a.hairloom")));
    finishWork();
    EXPECT_EQ(drag(), 5);
    EXPECT_TRUE(window->isWindowModified());
    EXPECT_EQ(readTextFile(file("a.hairloom")).value_or(""), "half a project");
}

}  // namespace
}  // namespace hairloom::editor
