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
    expectRefused("export g.hairloom --format hair -o g.hairloom", "is an input of this job");
    expectRefused("simulate g.hairloom --frames 2 --record g.hairloom", "is a Hairloom project");
    expectRefused("reference -o g.hairloom", "is a Hairloom project");
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
        EXPECT_NE(run("simulate g.hairloom --frames 2 --wind " + number + ",0,0").exitCode, 0) << number;
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

#ifndef _WIN32

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
