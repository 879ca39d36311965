// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/held_file.h"
#include "core/base/write_rules.h"
#include "tests/base/output_folder.h"

#ifndef _WIN32
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST_F(OutputFileTest, WritesReplacesAndLeavesNoTemporaryFile) {
    EXPECT_EQ(writeError("a.txt", "first"), "");
    EXPECT_EQ(writeError("a.txt", "second"), "");
    EXPECT_EQ(get("a.txt"), "second");
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(OutputFileTest, AFailedWriteLeavesNothing) {
    EXPECT_THAT(writeError("missing/a.txt", "x"), HasSubstr("cannot be written"));
    EXPECT_EQ(filesInFolder(), 0u);
    fs::create_directories(folder / "taken");
    EXPECT_THAT(writeError("taken", "x"), HasSubstr("is a folder"));
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(OutputFileTest, AnUnfinishedFileIsTakenAwayAndWhatWasThereStays) {
    put("a.txt", "old");
    {
        auto file = OutputFile::open(folder / "a.txt");
        ASSERT_TRUE(file) << file.error().message();
        ASSERT_TRUE(file->write(std::as_bytes(std::span("new", 3))));
        EXPECT_EQ(filesInFolder(), 2u);
    }
    EXPECT_EQ(get("a.txt"), "old");
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(OutputFileTest, AnotherKindOfFileIsReplacedOnlyByForce) {
    put("a.png", "\x89PNG\r\n\x1a\n....");
    put("a.json", "{}");
    put("empty", "");
    EXPECT_THAT(writeError("a.png", "plain text"), HasSubstr("is a PNG image and would be replaced by text"));
    EXPECT_THAT(writeError("a.json", "plain text"), HasSubstr("is JSON"));
    EXPECT_EQ(get("a.png"), "\x89PNG\r\n\x1a\n....");
    EXPECT_EQ(writeError("a.json", "[1]"), "");
    EXPECT_EQ(writeError("empty", "plain text"), "");
    setWriteRules({.force = true});
    EXPECT_EQ(writeError("a.png", "plain text"), "");
    EXPECT_EQ(get("a.png"), "plain text");
}

TEST_F(OutputFileTest, KindsAreToldFromTheContent) {
    const auto kind = [](std::string_view text) {
        return contentKind(std::as_bytes(std::span(text.data(), text.size())));
    };
    using std::string_view_literals::operator""sv;
    EXPECT_EQ(kind(""), content::kEmpty);
    EXPECT_EQ(kind("HAIRLOOM\1\0"sv), content::kProject);
    EXPECT_EQ(kind("HAIR\1\0"sv), "a .hair file");
    EXPECT_EQ(kind("\0\0\x80\x40\1"sv), "a TressFX 4 file");
    EXPECT_EQ(kind("Ogawa\xff\0\1"sv), "an Alembic file");
    EXPECT_EQ(kind("# made by hand\n\nv 1 2 3\n"), "an OBJ file");
    EXPECT_EQ(kind("# Notes\n\nvery short\n"), "text");
    EXPECT_EQ(kind("  {\"a\": 1}"), content::kJson);
    EXPECT_EQ(kind(std::string_view("\0\0\0\x20"
                                    "ftypisom",
                                    12)),
              content::kMp4);
    EXPECT_EQ(kind("RIFF\1\2\3\4WEBPVP8 "), "a WebP image");
    EXPECT_EQ(kind("\1\2\3"), "of no known kind");
}

TEST_F(OutputFileTest, SuffixesTellTheKindsOfWhatIsToBeWritten) {
    using std::string_view_literals::operator""sv;
    EXPECT_EQ(contentKindOfSuffix("tfx"), contentKind(std::as_bytes(std::span("\0\0\x80\x40\1"sv))));
    EXPECT_EQ(contentKindOfSuffix("obj"), contentKind(std::as_bytes(std::span("v 1 2 3\n"sv))));
    EXPECT_EQ(contentKindOfSuffix("glb"), contentKindOfSuffix("vrm"));
    EXPECT_EQ(contentKindOfSuffix("fbx"), "") << "not told by its beginning";
    EXPECT_EQ(contentKindOfSuffix(""), "");
}

TEST_F(OutputFileTest, WhatWasReadIsKeptAndAProjectMayBeSavedOver) {
    setWriteRules({.keepInputs = true});
    put("a.txt", "words");
    put("p.hairloom", "HAIRLOOM one");
    ASSERT_TRUE(readFile(folder / "a.txt"));
    ASSERT_TRUE(readFile(folder / "p.hairloom"));
    EXPECT_THAT(writeError("a.txt", "other words"), HasSubstr("is an input file"));
    EXPECT_EQ(writeError("p.hairloom", "HAIRLOOM two"), "");
    EXPECT_EQ(writeError("b.txt", "one"), "");
    ASSERT_TRUE(readFile(folder / "b.txt"));
    EXPECT_EQ(writeError("b.txt", "two"), "") << "its own output, read back";
}

TEST_F(OutputFileTest, AProjectThatSomebodyElseChangedMeanwhileIsKept) {
    setWriteRules({.keepInputs = true});
    put("p.hairloom", "HAIRLOOM one");
    ASSERT_TRUE(readFile(folder / "p.hairloom"));
    put("p.hairloom", "HAIRLOOM theirs");
    EXPECT_THAT(writeError("p.hairloom", "HAIRLOOM ours"), HasSubstr("changed by another program"));
    EXPECT_EQ(get("p.hairloom"), "HAIRLOOM theirs");
}

TEST_F(OutputFileTest, WhatAnotherPutInItsPlaceIsSeenByTheName) {
    setWriteRules({.keepInputs = true});
    put("p.hairloom", "HAIRLOOM one");
    ASSERT_TRUE(readFile(folder / "p.hairloom"));
    EXPECT_FALSE(isChangedByOthers(folder / "p.hairloom"));
    put("beside", "HAIRLOOM theirs");
    fs::rename(folder / "beside", folder / "p.hairloom");
    EXPECT_TRUE(isChangedByOthers(folder / "p.hairloom"));
    EXPECT_THAT(writeError("p.hairloom", "HAIRLOOM ours"), HasSubstr("changed by another program"));
    forgetInput(folder / "p.hairloom");
    EXPECT_EQ(writeError("p.hairloom", "HAIRLOOM ours"), "");
    EXPECT_FALSE(isChangedByOthers(folder / "p.hairloom"));
    put("p.hairloom", "HAIRLOOM theirs again");
    EXPECT_TRUE(isChangedByOthers(folder / "p.hairloom"));
    EXPECT_THAT(writeError("p.hairloom", "HAIRLOOM ours"), HasSubstr("since it was written"));
}

TEST_F(OutputFileTest, NamesThatAreKeptNewReplaceNothingButTheirOwn) {
    setWriteRules({.force = true, .keepInputs = true});
    keepNew(folder / "hair_v003");
    EXPECT_EQ(writeError("hair_v003.txt", "one"), "");
    EXPECT_EQ(writeError("hair_v003.txt", "two"), "") << "its own";
    put("hair_v003.report.txt", "theirs");
    EXPECT_THAT(writeError("hair_v003.report.txt", "ours"), HasSubstr("made by another job"));
    EXPECT_EQ(get("hair_v003.report.txt"), "theirs");
    put("hair_v002.txt", "older");
    EXPECT_EQ(writeError("hair_v002.txt", "ours"), "") << "another name";
    // What comes while the file is being written is kept as well.
    auto file = OutputFile::open(folder / "hair_v003.late.txt");
    ASSERT_TRUE(file);
    put("hair_v003.late.txt", "theirs");
    ASSERT_TRUE(file->write(std::as_bytes(std::span("ours", 4))));
    EXPECT_FALSE(file->finish());
    EXPECT_EQ(get("hair_v003.late.txt"), "theirs");
    setWriteRules({});
    EXPECT_EQ(writeError("hair_v003.report.txt", "ours"), "");
}

TEST_F(OutputFileTest, InputsThatWereNotedAreListedUntilTheyAreWritten) {
    setWriteRules({.keepInputs = true});
    put("a.txt", "words");
    put("p.hairloom", "HAIRLOOM one");
    ASSERT_TRUE(readFile(folder / "p.hairloom"));
    ASSERT_TRUE(readFile(folder / "a.txt"));
    const fs::path real = fs::canonical(folder);
    EXPECT_EQ(notedInputs(), (std::vector<fs::path>{real / "a.txt", real / "p.hairloom"}));
    EXPECT_EQ(writeError("p.hairloom", "HAIRLOOM two"), "");
    EXPECT_EQ(notedInputs(), std::vector<fs::path>{real / "a.txt"});
}

TEST_F(OutputFileTest, AFreedNumberOfAFileIsNoInput) {
    setWriteRules({.keepInputs = true});
    put("a.txt", "words");
    ASSERT_TRUE(readFile(folder / "a.txt"));
    fs::rename(folder / "a.txt", folder / "b.txt");
    put("a.txt", "other words, which another program wrote");
    EXPECT_EQ(writeError("b.txt", "mine"), "") << "it is not what has the name that was read";
}

TEST_F(OutputFileTest, AHeldFileIsHeldByOneAndGoesWithIt) {
    {
        auto held = HeldFile::hold(folder / "held");
        ASSERT_TRUE(held);
        EXPECT_FALSE(HeldFile::hold(folder / "held"));
    }
    EXPECT_EQ(filesInFolder(), 0u);
    put("held", "of a program that was killed");
    EXPECT_TRUE(HeldFile::hold(folder / "held"));
    EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(OutputFileTest, HardLinksStayLinks) {
    put("a.txt", "a long text that was there before");
    fs::create_hard_link(folder / "a.txt", folder / "b.txt");
    EXPECT_EQ(writeError("a.txt", "short"), "");
    EXPECT_EQ(get("b.txt"), "short");
#ifndef _WIN32  // where the standard library counts one for every file
    EXPECT_EQ(fs::hard_link_count(folder / "a.txt"), 2u);
#endif
    EXPECT_EQ(filesInFolder(), 2u);
}

TEST_F(OutputFileTest, EqualContentTouchesNothing) {
    EXPECT_EQ(writeError("a.txt", "the same"), "");
    const auto before = fs::last_write_time(folder / "a.txt") - std::chrono::hours(1);
    fs::last_write_time(folder / "a.txt", before);
    EXPECT_EQ(writeError("a.txt", "the same"), "");
    EXPECT_EQ(fs::last_write_time(folder / "a.txt"), before);
    EXPECT_EQ(writeError("a.txt", "the Same"), "");
    EXPECT_GT(fs::last_write_time(folder / "a.txt"), before);
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(OutputFileTest, ALiveWriterLeavesNothingOverAndAName) {
    put("a.txt", "old");
    auto file = OutputFile::open(folder / "a.txt");
    ASSERT_TRUE(file);
    EXPECT_TRUE(findLeftOvers(folder).empty());
}

TEST_F(OutputFileTest, LeftOversAreFoundWithTheirTargetAndRemoved) {
    put(".hair.tfx.0123456789abc.hairloom-part", "half");
    put(".g.hairloom.0123456789abc.hairloom-whole", "all of it");
    put(".other", "");
    const auto found = findLeftOvers(folder);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].target, "g.hairloom");
    EXPECT_TRUE(found[0].whole);
    EXPECT_EQ(found[1].target, "hair.tfx");
    EXPECT_EQ(found[1].bytes, 4u);
    for (const LeftOver& leftOver : found) EXPECT_TRUE(removeLeftOver(leftOver));
    EXPECT_EQ(filesInFolder(), 1u);
    EXPECT_TRUE(findLeftOvers(folder / "none").empty());
}

#ifndef _WIN32

TEST_F(OutputFileTest, SymbolicLinksAreFollowedAlsoWhereTheyLeadToNothingYet) {
    fs::create_directories(folder / "there");
    put("there/a.txt", "old");
    fs::create_symlink("there/a.txt", folder / "link");
    fs::create_symlink("there/new.txt", folder / "dangling");
    fs::create_symlink("circle", folder / "circle");
    EXPECT_EQ(writeError("link", "new"), "");
    EXPECT_EQ(writeError("dangling", "new"), "");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
    EXPECT_EQ(get("there/a.txt"), "new");
    EXPECT_EQ(get("there/new.txt"), "new");
    EXPECT_THAT(writeError("circle", "new"), HasSubstr("circular link"));
}

TEST_F(OutputFileTest, ModeOwnerAttributesAndTimeOfAccessAreKept) {
    put("a.txt", "old");
    const std::string path = (folder / "a.txt").string();
    ASSERT_EQ(chmod(path.c_str(), 0640), 0);
    const bool owned = geteuid() == 0 && chown(path.c_str(), 1234, 2345) == 0;
    const timespec times[2] = {{1'000'000'000, 500}, {1'000'000'000, 500}};
    ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
    EXPECT_EQ(writeError("a.txt", "new"), "");
    struct stat info {};
    ASSERT_EQ(stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0640u);
    EXPECT_EQ(info.st_atim.tv_sec, 1'000'000'000);
    EXPECT_GT(info.st_mtim.tv_sec, 1'000'000'000);
    if (owned) {
        EXPECT_EQ(info.st_uid, 1234u);
        EXPECT_EQ(info.st_gid, 2345u);
    }
}

TEST_F(OutputFileTest, NewFilesHaveTheModeOfTheUmask) {
    const mode_t before = umask(027);
    EXPECT_EQ(writeError("a.txt", "new"), "");
    umask(before);
    struct stat info {};
    ASSERT_EQ(stat((folder / "a.txt").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0640u);
}

TEST_F(OutputFileTest, DevicesAndFifosAreWrittenThroughByForceAlone) {
    const fs::path fifo = folder / "fifo";
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_THAT(writeError("fifo", "x"), HasSubstr("is a FIFO"));
    const auto null = writeFileAtomically("/dev/null", std::string_view("x"));
    ASSERT_FALSE(null);
    EXPECT_THAT(null.error().message(), HasSubstr("is a device"));
    EXPECT_FALSE(readFile(fifo)) << "and reading does not wait";
    setWriteRules({.force = true});
    EXPECT_TRUE(writeFileAtomically("/dev/null", std::string_view("x")));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    const auto full = writeFileAtomically("/dev/full", std::string_view("x"));
    ASSERT_FALSE(full);
    EXPECT_THAT(full.error().message(), HasSubstr("No space left"));
}

TEST_F(OutputFileTest, ReadOnlyFilesAreKeptAlsoFromTheSuperuser) {
    put("a.txt", "old");
    ASSERT_EQ(chmod((folder / "a.txt").c_str(), 0444), 0);
    EXPECT_THAT(writeError("a.txt", "new"), HasSubstr("is read-only"));
    EXPECT_EQ(get("a.txt"), "old");
    setWriteRules({.force = true});
    EXPECT_EQ(writeError("a.txt", "new"), "");
    struct stat info {};
    ASSERT_EQ(stat((folder / "a.txt").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 07777, 0444u);
}

TEST_F(OutputFileTest, ALinkLaidByAnotherUserInAFolderForAllIsNotFollowed) {
    if (geteuid() != 0) GTEST_SKIP() << "needs the superuser to lay another user's link";
    ASSERT_EQ(chmod(folder.c_str(), 01777), 0);
    put("private", "secret");
    fs::create_symlink(folder / "private", folder / "link");
    ASSERT_EQ(lchown((folder / "link").c_str(), 1234, 1234), 0);
    EXPECT_THAT(writeError("link", "x"), HasSubstr("another user"));
    EXPECT_EQ(get("private"), "secret");
}

/// A process that has the file open for writing until its pipe is closed; its id, and the pipe's end in
/// `hold`.
pid_t writerOf(const fs::path& path, int& hold, bool handleSignals = false) {
    int ready[2], end[2];
    if (pipe(ready) != 0 || pipe(end) != 0) return -1;
    const pid_t id = fork();
    if (id == 0) {
        close(end[1]);
        if (handleSignals) removeTemporariesWhenEnded();
        auto file = OutputFile::open(path);
        char byte = file ? 'y' : 'n';
        if (::write(ready[1], &byte, 1) == 1) [[maybe_unused]]
            const auto ended = ::read(end[0], &byte, 1);
        file = fail("closed");
        _exit(0);
    }
    char byte = 'n';
    close(end[0]);
    close(ready[1]);
    if (::read(ready[0], &byte, 1) != 1 || byte != 'y') return -1;
    close(ready[0]);
    hold = end[1];
    return id;
}

TEST_F(OutputFileTest, OfTwoWritersTheSecondIsTold) {
    put("a.txt", "old");
    int hold = -1;
    const pid_t id = writerOf(folder / "a.txt", hold);
    ASSERT_GT(id, 0);
    EXPECT_THAT(writeError("a.txt", "new"), HasSubstr("another program is writing it"));
    EXPECT_EQ(writeError("b.txt", "new"), "");
    EXPECT_TRUE(findLeftOvers(folder).empty());
    close(hold);
    waitpid(id, nullptr, 0);
    EXPECT_EQ(writeError("a.txt", "new"), "");
    EXPECT_EQ(filesInFolder(), 2u);
}

TEST_F(OutputFileTest, AKilledWriterLeavesALeftOverAndOneThatIsEndedNone) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
        int hold = -1;
        const pid_t id = writerOf(folder / "a.txt", hold, true);
        ASSERT_GT(id, 0);
        EXPECT_EQ(filesInFolder(), 1u);
        kill(id, signal);
        int status = 0;
        waitpid(id, &status, 0);
        close(hold);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
        const auto left = findLeftOvers(folder);
        EXPECT_EQ(left.size(), signal == SIGKILL ? 1u : 0u) << signal;
        for (const LeftOver& leftOver : left) EXPECT_EQ(leftOver.target, "a.txt");
    }
    EXPECT_EQ(writeError("a.txt", "new"), "") << "a left-over stops nobody";
}

#endif

}  // namespace
}  // namespace hairloom
