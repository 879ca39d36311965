// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/output_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/base/file.h"
#include "core/base/write_rules.h"
#include "tests/base/output_folder.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>
#endif

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class OutputBatchTest : public OutputFileTest {};

TEST_F(OutputBatchTest, OfSeveralFilesAllComeOrNone) {
    put("a.txt", "old");
    {
        const OutputBatch batch;
        EXPECT_EQ(writeError("a.txt", "new"), "");
        EXPECT_EQ(writeError("b.txt", "new"), "");
    }
    EXPECT_EQ(get("a.txt"), "old");
    EXPECT_EQ(filesInFolder(), 1u);
    {
        OutputBatch batch;
        EXPECT_EQ(writeError("a.txt", "new"), "");
        EXPECT_EQ(writeError("b.txt", "new"), "");
        EXPECT_EQ(get("a.txt"), "old");
        fs::create_directories(folder / "b.txt");
        const auto status = batch.commit();
        ASSERT_FALSE(status);
        EXPECT_THAT(status.error().message(), HasSubstr("is a folder"));
    }
    EXPECT_EQ(get("a.txt"), "old");
    fs::remove(folder / "b.txt");
    EXPECT_EQ(filesInFolder(), 1u);
    OutputBatch batch;
    EXPECT_EQ(writeError("a.txt", "new"), "");
    ASSERT_TRUE(writeFiles(folder, {{"c.txt", "one"}, {"d.txt", "two"}}));
    EXPECT_FALSE(fs::exists(folder / "c.txt")) << "a batch inside is part of the outer one";
    EXPECT_EQ(waitingFiles(), (std::vector<fs::path>{folder / "a.txt", folder / "c.txt", folder / "d.txt"}));
    ASSERT_TRUE(batch.commit());
    EXPECT_EQ(get("a.txt"), "new");
    EXPECT_EQ(get("d.txt"), "two");
    EXPECT_EQ(filesInFolder(), 3u);
}

/// A folder of files in every state, of which each is replaced before the last one cannot be.
class BatchThatFailsTest : public OutputFileTest {
  protected:
    void putOldFiles() {
        setWriteRules({.force = true, .keepInputs = true});
        put("a.txt", "old");
        put("linked.txt", "a long text that was there before");
        fs::create_hard_link(folder / "linked.txt", folder / "second.txt");
        put("same.txt", "new");
        put("twice.txt", "old");
        // Read before: it is an input like before once it is back.
        noteInput(folder / "a.txt");
        before = fs::last_write_time(folder / "linked.txt");
    }
    void writeNewFiles() const {
        for (const char* name : {"a.txt", "linked.txt", "new.txt", "same.txt", "twice.txt"})
            EXPECT_EQ(writeError(name, "new"), "");
        EXPECT_EQ(writeError("twice.txt", "newer"), "");
    }
    void expectOldFiles() const {
        EXPECT_EQ(get("a.txt"), "old");
        EXPECT_EQ(get("linked.txt"), "a long text that was there before");
        EXPECT_TRUE(fs::equivalent(folder / "linked.txt", folder / "second.txt"));
        EXPECT_EQ(fs::last_write_time(folder / "linked.txt"), before);
        EXPECT_EQ(get("twice.txt"), "old");
        EXPECT_FALSE(fs::exists(folder / "new.txt"));
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            names.insert(entry.path().filename().string());
        EXPECT_THAT(names,
                    testing::ElementsAre("a.txt", "linked.txt", "same.txt", "second.txt", "twice.txt"));
        EXPECT_FALSE(isChangedByOthers(folder / "a.txt"));
    }
    fs::file_time_type before;
};

#ifdef _WIN32
TEST_F(BatchThatFailsTest, PutsBackWhatItHasReplaced) {
    putOldFiles();
    put("z.txt", "old");
    const HANDLE held = CreateFileW((folder / "z.txt").c_str(), GENERIC_READ, FILE_SHARE_READ, nullptr,
                                    OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
    ASSERT_NE(held, INVALID_HANDLE_VALUE);
    {
        OutputBatch batch;
        writeNewFiles();
        EXPECT_EQ(writeError("z.txt", "new"), "");
        const auto status = batch.commit();
        ASSERT_FALSE(status);
        EXPECT_THAT(status.error().message(), HasSubstr("z.txt"));
        EXPECT_THAT(status.error().message(), Not(HasSubstr("put back")));
    }
    CloseHandle(held);
    EXPECT_EQ(get("z.txt"), "old");
    fs::remove(folder / "z.txt");
    expectOldFiles();
}
#else
TEST_F(BatchThatFailsTest, PutsBackWhatItHasReplaced) {
    putOldFiles();
    {
        OutputBatch batch;
        // A device takes its content last, wherever it stands.
        const auto begun = writeFileAtomically("/dev/full", std::string_view("x"));
        ASSERT_TRUE(begun) << begun.error().message();
        writeNewFiles();
        const auto status = batch.commit();
        ASSERT_FALSE(status);
        EXPECT_THAT(status.error().message(), HasSubstr("No space left"));
        EXPECT_THAT(status.error().message(), Not(HasSubstr("put back")));
    }
    expectOldFiles();
}

TEST_F(BatchThatFailsTest, SaysWhereTheOldContentIsThatCannotGoBack) {
    putOldFiles();
    const fs::path fifo = folder / "fifo";
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    std::string said;
    {
        OutputBatch batch;
        EXPECT_EQ(writeError("a.txt", "new"), "");
        EXPECT_EQ(writeError("fifo", std::string(200'000, 'x')), "");
        // Opens the pipe, by then with a.txt in place, makes a folder of a.txt and hangs up.
        std::thread reader([&] {
            const int end = ::open(fifo.c_str(), O_RDONLY);
            fs::remove(folder / "a.txt");
            fs::create_directories(folder / "a.txt" / "b");
            ::close(end);
        });
        const auto handler = std::signal(SIGPIPE, SIG_IGN);
        const auto status = batch.commit();
        std::signal(SIGPIPE, handler);
        reader.join();
        ASSERT_FALSE(status);
        said = status.error().message();
    }
    EXPECT_THAT(said, HasSubstr("a.txt cannot be put back"));
    const auto begin = said.find("what was there is in '");
    ASSERT_NE(begin, std::string::npos) << said;
    const auto first = said.find('\'', begin) + 1;
    std::ifstream kept(said.substr(first, said.find('\'', first) - first));
    std::string content;
    kept >> content;
    EXPECT_EQ(content, "old") << said;
}
#endif

}  // namespace
}  // namespace hairloom
