// SPDX-License-Identifier: GPL-3.0-or-later
// What guards the reading of foreign files, where a system lacks some of it, and what files may name.

#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/cli/command.h"

#ifndef _WIN32
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ForeignFiles : public CommandLineTest {};

TEST_F(ForeignFiles, ViewsNameImagesBesideThemselvesOrWhereAllowed) {
    runJson(createArguments());
    fs::create_directories(folder / "views" / "skies");
    fs::create_directories(folder / "elsewhere");
    runJson("render hair.hairloom --size 8x8 --passes 1 -o elsewhere/sky.png");
    fs::copy_file(folder / "elsewhere/sky.png", folder / "views/skies/sky.png");
    const auto render = [&](const std::string& image, const std::string& more = {}) {
        std::ofstream(folder / "views/v.json")
            << R"({"lights": [{"type": "environment", "image": ")" << image << R"("}]})";
        return run("render hair.hairloom --size 8x8 --passes 1 --force -o v.png --view views/v.json" + more);
    };
    EXPECT_EQ(render("skies/sky.png").exitCode, 0);
    const std::string absolute = (folder / "elsewhere/sky.png").generic_string();
    for (const std::string& image :
         {std::string("../elsewhere/sky.png"), absolute, std::string("skies/../../elsewhere/sky.png")}) {
        const Outcome outcome = render(image);
        EXPECT_EQ(outcome.exitCode, 1) << image;
        EXPECT_THAT(outcome.errors, HasSubstr("outside the folder of the view")) << image;
        EXPECT_EQ(render(image, " --images elsewhere").exitCode, 0) << image;
    }
#ifndef _WIN32
    // Wherever a link leads is where the image lies.
    fs::create_symlink("../elsewhere/sky.png", folder / "views/link.png");
    EXPECT_EQ(render("link.png").exitCode, 1);
    // Nothing is told of files that are not there either.
    EXPECT_THAT(render("../elsewhere/none.png").errors, HasSubstr("outside the folder of the view"));
#endif
}

#ifdef __linux__

/// A sheet of many faces.
void writeLargeObj(const fs::path& path) {
    constexpr int kSide = 1400;
    std::ofstream file(path);
    for (int i = 0; i < kSide * kSide; ++i)
        file << "v " << 0.0001 * (i % kSide) << " 0.1 " << 0.0001 * (i / kSide) << '\n';
    for (int i = 1; i + kSide + 1 <= kSide * kSide; ++i) {
        if (i % kSide != 0)
            file << "f " << i << ' ' << i + kSide << ' ' << i + kSide + 1 << ' ' << i + 1 << '\n';
    }
}

/// Waits until there are, or are no, processes that read the file, which stands in their words.
bool waitForReaders(const fs::path& file, bool some, std::chrono::seconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    do {
        bool found = false;
        for (const auto& process : fs::directory_iterator("/proc")) {
            std::ifstream words(process.path() / "cmdline");
            const std::string all{std::istreambuf_iterator<char>(words), {}};
            found = found || (all.find("hairloom-mesh-reader") != std::string::npos &&
                              all.find(file.string()) != std::string::npos);
        }
        if (found == some) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (std::chrono::steady_clock::now() < end);
    return false;
}

TEST_F(ForeignFiles, TheReaderEndsWithTheJobHoweverThatEnds) {
    const fs::path file = folder / "large.obj";
    writeLargeObj(file);
    for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
        const pid_t job = fork();
        ASSERT_GE(job, 0);
        if (job == 0) {
            // Shells let jobs in the background not hear Ctrl+C.
            ::signal(SIGINT, SIG_DFL);
            fs::current_path(folder);
            execl(HAIRLOOM_CLI, HAIRLOOM_CLI, "--quiet", "create", "--mesh", file.c_str(), "--scalp", "all",
                  "--count", "10", "-o", "a.hairloom", nullptr);
            _exit(127);
        }
        EXPECT_TRUE(waitForReaders(file, true, std::chrono::seconds(60))) << "nothing is read";
        kill(job, signal);
        int status = 0;
        waitpid(job, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status)) << "the job was done before " << signal;
        EXPECT_TRUE(waitForReaders(file, false, std::chrono::seconds(2))) << "after signal " << signal;
        EXPECT_FALSE(fs::exists(folder / "a.hairloom"));
    }
}

#endif

#if defined(HAIRLOOM_TEST_DENIED) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

class GuardLayers : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        std::ofstream(folder / "two.txt") << "0 0 0\n0 0.1 0\n\n0.1 0 0\n0.1 0.1 0\n";
        layers = runJson("devices --security")["security"];
    }
    /// The command line where the kernel answers these calls with these numbers of errors.
    Outcome runDenied(const std::string& calls, const std::string& arguments) const {
        const std::string command = "cd '" + folder.string() + "' && '" HAIRLOOM_TEST_DENIED "' " + calls +
                                    " -- '" HAIRLOOM_CLI "' " + arguments + " > out.txt 2> errors.txt";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(folder / "out.txt"),
                readText(folder / "errors.txt")};
    }
    nlohmann::json layers;
};

constexpr const char* kNoLandlock = "landlock_create_ruleset=38 ";  // ENOSYS
constexpr const char* kNoNamespaces = "unshare=1 ";                 // EPERM
constexpr const char* kNoSeccomp = "prctl=22 ";                     // EINVAL

TEST_F(GuardLayers, WhatAKernelLacksIsSaidOnceAndFilesAreRead) {
    struct Case {
        std::string denied;
        std::vector<std::string> missing;
    };
    for (const Case& one : {Case{kNoLandlock, {"files"}}, Case{kNoNamespaces, {"processes", "paths"}},
                            Case{std::string(kNoLandlock) + kNoNamespaces, {"files", "processes", "paths"}},
                            Case{std::string(kNoLandlock) + kNoNamespaces + kNoSeccomp,
                                 {"files", "processes", "paths", "system_calls"}}}) {
        const Outcome read = runDenied(one.denied, "import two.txt --force -o a.hairloom");
        EXPECT_EQ(read.exitCode, 0) << one.denied << read.errors;
        const auto first = read.errors.find("runs without");
        ASSERT_NE(first, std::string::npos) << read.errors;
        EXPECT_EQ(read.errors.find("runs without", first + 1), std::string::npos) << read.errors;
        const auto found = nlohmann::json::parse(runDenied(one.denied, "devices --security --json").output);
        for (const std::string& layer : one.missing) {
            EXPECT_THAT(read.errors.substr(first), HasSubstr(layer + " (")) << one.denied;
            EXPECT_EQ(found["security"]["layer_" + layer], "missing") << one.denied;
        }
        EXPECT_EQ(found["security"]["layer_memory"], "set");
    }
}

TEST_F(GuardLayers, WhatCannotBeSetRefusesUnlessAllowed) {
    if (layers["layer_files"] != "set") GTEST_SKIP() << "this kernel has no Landlock";
    const std::string denied = "landlock_restrict_self=5 ";  // EIO
    const Outcome refused = runDenied(denied, "import two.txt -o a.hairloom");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.errors, HasSubstr("could not be confined: files ("));
    EXPECT_THAT(refused.errors, HasSubstr("--allow-unconfined"));
    EXPECT_FALSE(fs::exists(folder / "a.hairloom"));
    const auto found = nlohmann::json::parse(runDenied(denied, "devices --security --json").output);
    EXPECT_EQ(found["security"]["layer_files"], "failed");
    const Outcome allowed = runDenied(denied, "--allow-unconfined import two.txt -o a.hairloom");
    EXPECT_EQ(allowed.exitCode, 0) << allowed.errors;
    EXPECT_THAT(allowed.errors, HasSubstr("runs without files ("));
}

#endif

}  // namespace
}  // namespace hairloom::test
