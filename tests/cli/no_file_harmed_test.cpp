// SPDX-License-Identifier: GPL-3.0-or-later
// No job harms a file that it was not asked to replace, and what goes wrong is told to people and programs.

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#ifndef _WIN32
#include <sys/wait.h>
#endif

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class NoFileHarmed : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        runJson("create --mesh '" + bustFile() +
                "' --scalp material:scalp --count 40 --length 0.1 --points 8 --seed 3 -o g.hairloom");
        project = readText(folder / "g.hairloom");
    }
    /// Fails with 1, says why, and leaves the project and nothing new in the folder.
    void expectRefused(const std::string& arguments, const std::string& why) const {
        const auto before = names();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 1) << arguments;
        EXPECT_THAT(outcome.errors, HasSubstr(why)) << arguments;
        EXPECT_EQ(readText(folder / "g.hairloom"), project) << arguments;
        EXPECT_EQ(names(), before) << arguments;
    }
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder))
            found.push_back(entry.path().filename().string());
        std::ranges::sort(found);
        return found;
    }
    std::string project;
};

TEST_F(NoFileHarmed, AJobSavesOverItsProjectAndExportsNeverDo) {
    expectRefused("export g.hairloom --format hair -o g.hairloom", "is an input file");
    expectRefused("simulate g.hairloom --frames 2 --record g.hairloom", "is a Hairloom project");
    expectRefused("reference -o g.hairloom", "is a Hairloom project");
    runJson("export g.hairloom --format hair -o a.hair");
    expectRefused("export a.hair --format hair -o a.hair", "is an input file");
    runJson("set g.hairloom simulation.windSpeed=1 -o g.hairloom");
    EXPECT_NE(readText(folder / "g.hairloom"), project);
    EXPECT_EQ(runJson("info g.hairloom")["strands"], 40);
}

TEST_F(NoFileHarmed, OtherKindsAreReplacedByForceAlone) {
    runJson("export g.hairloom --format hair -o a.hair");
    const std::string hair = readText(folder / "a.hair");
    expectRefused("set g.hairloom simulation.windSpeed=1 -o a.hair", "is a .hair file");
    expectRefused("export g.hairloom --format tfx --points 8 -o a.hair", "is a .hair file");
    EXPECT_EQ(readText(folder / "a.hair"), hair);
    runJson("export a.hair --format tfx --points 8 -o a.hair --force");
    EXPECT_NE(readText(folder / "a.hair"), hair);
}

TEST_F(NoFileHarmed, CompanionsAreHeldToTheSameRules) {
    std::ofstream(folder / "a.hair.report.json") << "my notes\n";
    expectRefused("export g.hairloom --format hair -o a.hair", "a.hair.report.json: is text");
    EXPECT_EQ(readText(folder / "a.hair.report.json"), "my notes\n");
    std::ofstream(folder / "b.tfxmesh") << "my notes\n";
    expectRefused("export g.hairloom --format tfx --points 8 -o b.tfx", "b.tfxmesh: is text");
    EXPECT_EQ(readText(folder / "b.tfxmesh"), "my notes\n");
}

TEST_F(NoFileHarmed, ErrorsAreAnObjectForPrograms) {
    std::ofstream(folder / "bad.obj") << "v 0 0 0\nv 0 1 0\nl 1 9\n";
    const Outcome outcome = run("import bad.obj -o b.hairloom --json");
    EXPECT_EQ(outcome.exitCode, 1);
    const auto error = outcome.json()["error"];
    EXPECT_EQ(error["file"], "bad.obj");
    EXPECT_EQ(error["place"]["line"], 3);
    EXPECT_THAT(error["what"].get<std::string>(), HasSubstr("9"));
    EXPECT_TRUE(error["expected"].is_string());
    const Outcome usage = run("import --json");
    EXPECT_EQ(usage.exitCode, 2);
    EXPECT_THAT(usage.errors, testing::StartsWith("error: "));
    EXPECT_THAT(usage.errors, HasSubstr("hairloom-cli import --help"));
    EXPECT_TRUE(usage.json()["error"]["place"].is_null());
    EXPECT_THAT(usage.json()["error"]["what"].get<std::string>(), HasSubstr("required"));
}

TEST_F(NoFileHarmed, NumbersThatAreNoneAreRefusedOnEveryOption) {
    for (const std::string number :
         {"nan", "inf", "-inf", "NaN7", "1e99", "0x1p3", "''", "1,5", "1e", "12x"}) {
        const Outcome outcome = run("simulate g.hairloom --frames 2 --fps " + number);
        EXPECT_EQ(outcome.exitCode, 2) << number;
        EXPECT_THAT(outcome.errors, HasSubstr("--fps")) << number;
        EXPECT_EQ(run("simulate g.hairloom --frames " + number).exitCode, 2) << number;
        EXPECT_EQ(run("render g.hairloom -o p.png --exposure " + number).exitCode, 2) << number;
        EXPECT_EQ(run("--threads " + number + " info g.hairloom").exitCode, 2) << number;
        EXPECT_EQ(run("simulate g.hairloom --frames 2 --wind " + number + ",0,0").exitCode, 2) << number;
        EXPECT_EQ(run("bench place --strands 10," + number).exitCode, 2) << number;
    }
    EXPECT_EQ(run("simulate g.hairloom --frames 2 --fps 6e1").exitCode, 0);
}

TEST_F(NoFileHarmed, WhatAKilledRunLeftIsListedAndRemovedWhenAsked) {
    std::ofstream(folder / ".g.hairloom.0123456789abc.hairloom-part") << "half";
    EXPECT_THAT(run("set g.hairloom simulation.windSpeed=1 -o g.hairloom").errors,
                HasSubstr("hairloom-cli clean"));
    const auto listed = runJson("clean");
    ASSERT_EQ(listed["left_overs"].size(), 1u);
    EXPECT_EQ(listed["left_overs"][0]["target"], "g.hairloom");
    EXPECT_EQ(listed["removed"], 0);
    EXPECT_EQ(runJson("clean . --remove")["removed"], 1);
    EXPECT_TRUE(runJson("clean .")["left_overs"].empty());
    EXPECT_EQ(run("clean none").exitCode, 1);
}

TEST_F(NoFileHarmed, WrongUsageIsToldAlikeEverywhere) {
    for (const std::string arguments :
         {"", "nonsense", "set", "set g.hairloom nothing -o h.hairloom",
          "render g.hairloom -o p.png --size 0x9", "render g.hairloom -o p.png --size big",
          "render g.hairloom -o p.png --frames 1,2", "export g.hairloom -o a.hair",
          "export g.hairloom --target maya --format obj-c4d -o a.obj", "bench io --size 9x9",
          "accuracy g.hairloom -o acc --vary substeps", "info", "info g.hairloom --points",
          "simulate g.hairloom --frames 2 --wind 1,2", "groom g.hairloom -o h.hairloom"}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.errors;
        EXPECT_THAT(outcome.errors, testing::StartsWith("error: ")) << arguments;
        EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
        EXPECT_EQ(outcome.output, "") << arguments;
        const Outcome object = run(arguments + " --json");
        EXPECT_EQ(object.exitCode, 2) << arguments;
        EXPECT_TRUE(object.json()["error"]["what"].is_string()) << arguments;
        EXPECT_FALSE(fs::exists(folder / "acc")) << arguments;
    }
}

TEST_F(NoFileHarmed, PointsBeyondAKilometreAreRefusedWithTheUnitThatFits) {
    std::ofstream(folder / "far.obj") << "v 0 0 0\nv 0 .1 0\nv 0 .2 0\nv 0 1e38 0\nl 1 2\nl 3 4\n";
    expectRefused("import far.obj -o h.hairloom", "strand 1");
    std::ofstream millimetres(folder / "mm.obj");
    for (int s = 0; s < 60; ++s)
        millimetres << "v " << 4 * s << " 1700 0\nv " << 4 * s << " 1500 0\nl " << 2 * s + 1 << ' '
                    << 2 * s + 2 << '\n';
    millimetres.close();
    expectRefused("import mm.obj -o h.hairloom", "the unit mm would fit");
    EXPECT_EQ(runJson("import mm.obj --unit mm -o h.hairloom")["strands"], 60);
}

TEST_F(NoFileHarmed, FoldersAreTriedBeforeTheWorkAndGetAllOrNothing) {
    std::ofstream(folder / "taken") << "a file";
    expectRefused("stability g.hairloom -o taken", "taken");
    EXPECT_EQ(readText(folder / "taken"), "a file");
    fs::create_directories(folder / "cert");
    fs::create_directories(folder / "cert/certificate.json");
    expectRefused("stability g.hairloom --storms 2 -o cert", "is a folder");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "cert"), fs::directory_iterator()), 1);
    EXPECT_EQ(run("stability nothing.hairloom -o new/deep").exitCode, 1);
    EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST_F(NoFileHarmed, TheFolderOfCopiesOfUnsavedWorkIsLookedThrough) {
    const fs::path data = folder / "data";
    const fs::path recovery = data / "Hairloom/Hairloom/recovery";
    fs::create_directories(recovery);
#ifdef _WIN32
    _putenv_s("APPDATA", data.string().c_str());
#else
    setenv("XDG_DATA_HOME", data.c_str(), 1);
#endif
    fs::copy_file(folder / "g.hairloom", recovery / "0123.hairloom");
    std::ofstream(recovery / ".9.hairloom.0123456789abc.hairloom-part") << "half";
    auto found = runJson("clean");
    ASSERT_EQ(found["copies"].size(), 1u);
    EXPECT_EQ(found["left_overs"].size(), 1u);
    EXPECT_EQ(runJson("clean --remove")["removed"], 1);
    found = runJson("clean --remove --copies");
    EXPECT_EQ(found["removed"], 1);
    EXPECT_TRUE(fs::is_empty(recovery));
#ifndef _WIN32
    unsetenv("XDG_DATA_HOME");
#endif
}

TEST_F(NoFileHarmed, LargeScriptsAreRefusedBeforeTheyAreRead) {
    std::ofstream(folder / "s.json").put('[');
    fs::resize_file(folder / "s.json", std::uintmax_t{1} << 31u);
    expectRefused("groom g.hairloom --script s.json -o h.hairloom", "expected at most 8388608");
}

#ifndef _WIN32

TEST_F(NoFileHarmed, FifosAreNoInputsOfRecords) {
    ASSERT_EQ(std::system(("mkfifo '" + (folder / "fifo").string() + "'").c_str()), 0);
    expectRefused("simulate g.hairloom --frames 2 --against fifo", "is a device or a FIFO");
    expectRefused("export g.hairloom --format abc --record fifo --frames 0,1 -o a.abc",
                  "is a device or a FIFO");
    expectRefused("groom g.hairloom --script fifo -o h.hairloom", "is a device or a FIFO");
}

TEST_F(NoFileHarmed, AFullLimitOfFilesIsAnErrorWithWords) {
    const std::string command =
        "cd '" + folder.string() +
        "' && ( ulimit -f 8; '" HAIRLOOM_CLI
        "' set g.hairloom simulation.windSpeed=1 -o h.hairloom ) > /dev/null 2> errors.txt";
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status;
    EXPECT_THAT(readText(folder / "errors.txt"), HasSubstr("File too large"));
    EXPECT_FALSE(fs::exists(folder / "h.hairloom"));
}

#ifndef __SANITIZE_ADDRESS__  // which reserves more addresses than any limit

TEST_F(NoFileHarmed, ForeignFilesAreReadBelowALimitOfTheUsersOwn) {
    runJson("export g.hairloom --format hair -o a.hair");
    // KiB of addresses: less than what the process that reads is limited to.
    const std::string command = "cd '" + folder.string() +
                                "' && ( ulimit -v 1500000; '" HAIRLOOM_CLI
                                "' import a.hair -o i.hairloom ) > /dev/null 2> errors.txt";
    EXPECT_EQ(std::system(command.c_str()), 0) << readText(folder / "errors.txt");
    EXPECT_TRUE(fs::exists(folder / "i.hairloom"));
}

#endif

TEST_F(NoFileHarmed, NamesDoNotCommandTheTerminal) {
    for (const char* name : {"a\x1b[31mred.hair", "a\x7f.hair",
                             "a\xc2\x9b"
                             "31m.hair",
                             "a\nerror: b.hair"}) {
        const Outcome outcome = run("info '" + std::string(name) + "'");
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_THAT(outcome.errors, testing::StartsWith("error: a?"));
        EXPECT_EQ(outcome.errors.find('\n'), outcome.errors.size() - 1) << outcome.errors;
        EXPECT_EQ(outcome.errors.find_first_of("\x1b\x7f\x9b"), std::string::npos);
    }
    runJson("export g.hairloom --format hair -o 'a\x1b[31m.hair'");
    const Outcome read = run("import 'a\x1b[31m.hair' --unit m -o 'b\x1b[31m.hairloom'");
    EXPECT_EQ((read.output + read.errors).find('\x1b'), std::string::npos) << read.output << read.errors;
}

TEST_F(NoFileHarmed, AFileGoesThroughAPipeWhereNothingIsReadBack) {
    const std::string cli = "'" HAIRLOOM_CLI "' ";
    const auto shell = [&](const std::string& command) {
        const int status = std::system(("cd '" + folder.string() + "' && " + command).c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    };
    const std::string set = cli + "set g.hairloom simulation.windSpeed=1 -o ";
    EXPECT_EQ(shell(set + "h.hairloom > /dev/null"), 0);
    const std::string written = readText(folder / "h.hairloom");
    EXPECT_EQ(shell(set + "- > piped.hairloom 2> said.txt"), 0);
    EXPECT_EQ(readText(folder / "piped.hairloom"), written);
    EXPECT_THAT(readText(folder / "said.txt"), HasSubstr("changed"));
    EXPECT_EQ(shell(set + "/dev/stdout 2> /dev/null | cat > through.hairloom"), 0);
    EXPECT_EQ(readText(folder / "through.hairloom"), written);
    EXPECT_EQ(shell("mkfifo fifo && { cat fifo > read.hairloom & " + set + "fifo > /dev/null; wait; }"), 0);
    EXPECT_EQ(readText(folder / "read.hairloom"), written);
    EXPECT_EQ(shell(set + "- --json > object.json 2> /dev/null"), 2);
    EXPECT_THAT(readText(folder / "object.json"), HasSubstr("standard output"));
    EXPECT_EQ(shell(cli + "export g.hairloom --format hair -o - > none.hair 2> /dev/null"), 2);
    EXPECT_EQ(readText(folder / "none.hair"), "");
    EXPECT_EQ(shell(set + "- > /dev/full 2> said.txt"), 1);
    EXPECT_THAT(readText(folder / "said.txt"), HasSubstr("cannot be written"));
    EXPECT_FALSE(fs::exists(folder / "-"));
}

TEST_F(NoFileHarmed, DevicesAndReadOnlyFilesStay) {
    expectRefused("export g.hairloom --format hair -o /dev/null", "is a device");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    runJson("export g.hairloom --format hair -o /dev/null --force");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_FALSE(fs::exists("/dev/null.report.json"));
    fs::permissions(folder / "g.hairloom", fs::perms(0444));
    expectRefused("set g.hairloom simulation.windSpeed=1 -o g.hairloom", "is read-only");
}

/// Exit code and standard error of the program with its streams as the shell is told.
std::pair<int, std::string> runWith(const fs::path& folder, const std::string& arguments,
                                    const std::string& streams) {
    const std::string command = "cd '" + folder.string() + "' && { '" HAIRLOOM_CLI "' " + arguments + " " +
                                streams + "; } 2> errors.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(folder / "errors.txt")};
}

TEST_F(NoFileHarmed, FullOrClosedStandardOutputIsAnError) {
    for (const std::string job : {"info g.hairloom", "info g.hairloom --json", "--help", "--version"}) {
        for (const std::string stream : {"> /dev/full", ">&-"}) {
            const auto [exitCode, errors] = runWith(folder, job, stream);
            EXPECT_EQ(exitCode, 1) << job;
            EXPECT_THAT(errors, HasSubstr("standard output: cannot be written")) << job;
        }
    }
    const std::string set = "set g.hairloom simulation.windSpeed=1 -o h.hairloom";
    EXPECT_EQ(runWith(folder, set, ">&- <&- 2>&-").first, 1);
    EXPECT_EQ(runJson("info h.hairloom")["strands"], 40) << "what is printed never lands in a file";
}

#endif

}  // namespace
}  // namespace hairloom::test
