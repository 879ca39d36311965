// SPDX-License-Identifier: GPL-3.0-or-later
// Every job that writes tries its outputs before it works, and leaves all of them or none.

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <set>

#ifndef _WIN32
#include <sys/wait.h>
#endif

#include <nlohmann/json.hpp>

#include "tests/cli/command.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The arguments of a job, with OUT where a name to write goes.
struct Writes {
    const char* job;
    const char* option;
    const char* arguments;
    bool folder = false;
};

/// What takes longest when it works: a job that does not try first holds up the test.
constexpr Writes kWrites[] = {
    {"accuracy", "--output", "g.hairloom -o OUT", true},
    {"bench", "--markdown", "sim --markdown OUT"},
    {"bench", "--output", "gpu-sim -o OUT", true},
    {"budget", "--output", "g.hairloom --ms 5 -o OUT"},
    {"colliders", "--output", "g.hairloom --fit field -o OUT"},
    {"create", "--output", "--mesh MESH --count 5000 -o OUT"},
    {"export", "--output", "g.hairloom --format hair --certify -o OUT"},
    {"groom", "--output", "g.hairloom --script s.json -o OUT"},
    {"blend", "--output", "g.hairloom --with a.hair -o OUT"},
    {"guides", "--output", "g.hairloom --count 4 -o OUT"},
    {"import", "--output", "a.hair -o OUT"},
    {"import", "--record", "a.hair -o h.hairloom --record OUT"},
    {"lod", "--output", "g.hairloom -o OUT", true},
    {"pose", "--output", "g.hairloom --name A --make -o OUT"},
    {"reference", "--output", "-o OUT"},
    {"reference", "--man", "--man OUT", true},
    {"reference", "--jobs", "--jobs OUT"},
    {"render", "--output", "g.hairloom --size 2000x2000 -o OUT"},
    {"render", "--exr", "g.hairloom --size 2000x2000 -o p.png --exr OUT"},
    {"render", "--animation", "g.hairloom --size 2000x2000 -o p.png --animation OUT"},
    {"render", "--strip", "g.hairloom --size 2000x2000 -o p.png --strip OUT"},
    {"set", "--output", "g.hairloom simulation.windSpeed=1 -o OUT"},
    {"simulate", "--output", "g.hairloom --frames 5000 -o OUT"},
    {"simulate", "--record", "g.hairloom --frames 5000 --record OUT"},
    {"spheres", "--output", "g.hairloom --fit 8 -o OUT"},
    {"stability", "--output", "-o OUT", true},
    {"stability", "--output", "g.hairloom -o OUT", true},
    {"stack", "--output", "g.hairloom --bake -o OUT"},
    {"stack", "--keep", "g.hairloom --keep OUT"},
    {"sweep", "--output", "storms.json -o OUT", true},
    {"takes", "--output", "g.hairloom --export nod --format frames -o OUT"},
    {"timeline", "--output", "g.hairloom -o OUT"},
    {"timeline", "--keep", "g.hairloom --keep OUT"},
    {"timeline", "--keep-motion", "g.hairloom --keep-motion OUT"},
    {"transfer", "--output", "g.hairloom --to MESH -o OUT"},
};

std::string with(std::string text, const std::string& word, const std::string& by) {
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
    return text;
}

class Outputs : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        runJson("create --mesh '" + bustFile() +
                "' --scalp material:scalp --count 40 --length 0.1 --points 8 --seed 3 -o g.hairloom");
        runJson("export g.hairloom --format hair -o a.hair");
        std::ofstream(folder / "storms.json")
            << R"({"hairloom_sweep": 1, "job": "stability", "arguments": {"groom": "g.hairloom", "output": "{out}", "first-storm": "{first}"},)"
            << R"( "over": [{"name": "first", "from": 0, "to": 1, "step": 1}]})";
        std::ofstream(folder / "s.json")
            << R"({"hairloom_script": 1, "operations": [{"op": "curl", "radius": 0.01, "frequency": 40}]})";
    }
    static std::string command(const Writes& writes, const std::string& output) {
        return std::string(writes.job) + " " +
               with(with(writes.arguments, "OUT", output), "MESH", "'" + bustFile() + "'");
    }
    std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            found.insert(fs::relative(entry.path(), folder).string());
        return found;
    }
    /// Fails with 1 and a line of words, soon, and leaves nothing.
    void expectRefused(const Writes& writes, const std::string& output, const std::string& why) const {
        const std::string arguments = command(writes, output);
        const auto before = names();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 1) << arguments << "\n" << outcome.errors;
        EXPECT_THAT(outcome.errors, testing::StartsWith("error: " + output)) << arguments;
        EXPECT_THAT(outcome.errors, HasSubstr(why)) << arguments;
        EXPECT_EQ(names(), before) << arguments;
    }
};

TEST_F(Outputs, TheTableHasAllThatJobsWrite) {
    std::set<std::pair<std::string, std::string>> known, found;
    for (const Writes& writes : kWrites) known.emplace(writes.job, writes.option);
    std::istringstream jobs(run("--help").output);
    std::string line, word;
    bool isList = false;
    while (std::getline(jobs, line)) {
        if (isList && line.starts_with("  ") && line.size() > 2 && std::islower(line[2])) {
            std::istringstream(line) >> word;
            const std::string help = run(word + " --help").output;
            for (const std::string option : {"--output", "--record", "--man", "--exr", "--animation",
                                             "--strip", "--markdown", "--keep", "--keep-motion", "--jobs"}) {
                // A record that is read, and the name of a take.
                const bool isNoFile =
                    option == "--record" && (word == "export" || word == "render" || word == "takes");
                if (!isNoFile && help.find(option + " TEXT") != std::string::npos)
                    found.emplace(word, option);
            }
        }
        isList = isList || line.starts_with("Subcommands");
    }
    EXPECT_FALSE(found.empty());
    EXPECT_EQ(found, known);
}

// The module's own tests run in a lane of their own, which a new job would break unnoticed.
TEST_F(Outputs, TheTestsOfPythonCallEveryJob) {
    std::ifstream file(sourceDir() / "python/tests/test_jobs.py");
    const std::string calls{std::istreambuf_iterator<char>(file), {}};
    ASSERT_THAT(calls, HasSubstr("CALLS"));
    ASSERT_EQ(run("reference --jobs jobs.json").exitCode, 0);
    std::ifstream described(folder / "jobs.json");
    for (const auto& job : nlohmann::json::parse(described)["jobs"]) {
        const std::string name = job["name"];
        EXPECT_THAT(calls,
                    testing::AnyOf(HasSubstr("\"" + name + "\": ("), HasSubstr("\"" + name + "_\": (")));
    }
}

TEST_F(Outputs, AreTriedBeforeTheWork) {
    std::ofstream(folder / "text") << "my notes\n";
    fs::create_directories(folder / "taken");
    for (const Writes& writes : kWrites) {
        if (writes.folder) {
            expectRefused(writes, "text", "text");
            expectRefused(writes, "text/new", "text/new");
        } else {
            expectRefused(writes, "taken", "is a folder");
            expectRefused(writes, "none/new", "cannot be written");
            expectRefused(writes, "g.hairloom/new", "cannot be written");
        }
    }
    EXPECT_EQ(readText(folder / "text"), "my notes\n");
}

TEST_F(Outputs, GoThroughAPipeWhereOneFileIsWrittenAndNotReadBack) {
    const auto before = names();
    for (const Writes& writes : kWrites) {
        const std::string arguments = command(writes, "-") + " --json";
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.errors;
        EXPECT_THAT(outcome.errors, testing::AnyOf(HasSubstr("pipe"), HasSubstr("standard output")))
            << arguments;
    }
    EXPECT_EQ(names(), before);
    for (const char* job :
         {"guides g.hairloom --count 4 -o", "reference -o", "set g.hairloom simulation.windSpeed=1 -o",
          "simulate g.hairloom --frames 2 --record"}) {
        const Outcome piped = run(job + std::string(" -"));
        EXPECT_EQ(piped.exitCode, 0) << job << piped.errors;
        runJson(job + std::string(" file"));
        EXPECT_EQ(piped.output, readText(folder / "file")) << job;
        fs::remove(folder / "file");
    }
}

TEST_F(Outputs, NamesThatCannotBeMeantAreWrongUsage) {
    for (const Writes& writes : kWrites)
        EXPECT_EQ(run(command(writes, "''")).exitCode, 2) << writes.arguments;
    for (const char* arguments :
         {"render g.hairloom --size 32x32 -o p.png --exr p.png",
          "render g.hairloom --size 32x32 -o p.png --strip ./p.png",
          "simulate g.hairloom --frames 2 -o s.hairloom --record s.hairloom",
          "set g.hairloom simulation.windSpeed=1 -o stdout.txt", "reference -o /dev/stdout"}) {
        const auto before = names();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.errors;
        EXPECT_THAT(outcome.errors,
                    testing::AnyOf(HasSubstr("two outputs"), HasSubstr("standard output goes to")));
        EXPECT_EQ(names(), before) << arguments;
    }
}

TEST_F(Outputs, WhatIsKnownOfAFolderIsTriedBeforeTheWork) {
    for (const auto& [arguments, name] :
         {std::pair("accuracy g.hairloom -o f", "data.csv"),
          std::pair("accuracy g.hairloom --picture -o f", "picture.csv"),
          std::pair("stability -o f", "cases.json"), std::pair("lod g.hairloom -o f", "levels.glb"),
          std::pair("reference --man f", "hairloom.1")}) {
        fs::create_directories(folder / "f" / name);
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 1) << arguments;
        EXPECT_THAT(outcome.errors, HasSubstr(std::string(name) + ": is a folder")) << arguments;
        fs::remove(folder / "f" / name);
        EXPECT_TRUE(fs::is_empty(folder / "f")) << arguments;
    }
}

TEST_F(Outputs, AnExportReplacesItsOwnKindAndNoOtherBeforeTheWork) {
    for (const std::string format :
         {"abc", "abc-unreal", "hair", "obj-c4d", "obj-lines", "ply", "runtime", "tfx", "usda", "usdc"}) {
        std::ofstream(folder / "e.x") << "my notes\n";
        const std::string job = "export g.hairloom --points 8 --format " + format + " -o e.x";
        const Outcome refused = run(job);
        EXPECT_EQ(refused.exitCode, 1) << format;
        EXPECT_THAT(refused.errors, HasSubstr("error: e.x: is text and would be replaced by a")) << format;
        fs::remove(folder / "e.x");
        EXPECT_EQ(run(job).exitCode, 0) << format;
        EXPECT_EQ(run(job).exitCode, 0) << format;
        fs::remove(folder / "e.x");
    }
}

TEST_F(Outputs, PicturesOfASequenceAreTriedBeforeTheWork) {
    std::ofstream(folder / "p_0002.png") << "my notes\n";
    const auto before = names();
    const std::string sequence = "render g.hairloom --size 32x32 --passes 1 --turntable 3 -o ";
    const Outcome refused = run(sequence + "p.png");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.errors, HasSubstr("p_0002.png: is text"));
    EXPECT_EQ(names(), before);
    EXPECT_EQ(run(sequence + "- > /dev/null").exitCode, 2) << "several files do not go through a pipe";
}

#ifndef _WIN32

TEST_F(Outputs, ALimitOfFilesEndsEachJobBeforeTheWork) {
    for (const Writes& writes : kWrites) {
        const std::string arguments = command(writes, "new");
        const auto before = names();
        const std::string shell = "cd '" + folder.string() + "' && { ( ulimit -f 0; '" HAIRLOOM_CLI "' " +
                                  arguments + "; echo \"code $?\" ) 2>&1; } | cat > said.txt";
        ASSERT_EQ(std::system(shell.c_str()), 0);
        const std::string said = readText(folder / "said.txt");
        fs::remove(folder / "said.txt");
        EXPECT_THAT(said, HasSubstr("File too large")) << arguments;
        EXPECT_THAT(said, HasSubstr("code 1")) << arguments;
        EXPECT_EQ(names(), before) << arguments;
    }
}

TEST_F(Outputs, AnExportThatCannotBeReportedLeavesNothing) {
    // The strands take less than that, their report more; both wait for each other.
    for (const int blocks : {2, 3, 4, 6}) {
        const std::string shell = "cd '" + folder.string() + "' && ( ulimit -f " + std::to_string(blocks) +
                                  "; '" HAIRLOOM_CLI
                                  "' export g.hairloom --format tfx --points 8 -o e.tfx ) > "
                                  "/dev/null 2>&1";
        const int status = std::system(shell.c_str());
        const bool isThere = fs::exists(folder / "e.tfx");
        EXPECT_EQ(WEXITSTATUS(status) == 0, isThere) << blocks;
        EXPECT_EQ(fs::exists(folder / "e.tfx.report.json"), isThere) << blocks;
        for (const char* name : {"e.tfx", "e.tfx.report.json", "e.tfxbone", "e.tfxmesh"})
            fs::remove(folder / name);
    }
}

TEST_F(Outputs, AJobThatIsEndedLeavesNeitherFilesNorFolders) {
    for (const char* signal : {"TERM", "INT", "HUP"}) {
        const auto before = names();
        const std::string shell = "cd '" + folder.string() + "' && timeout -s " + signal +
                                  " 1 '" HAIRLOOM_CLI "' stability -o new/deep > /dev/null 2>&1";
        EXPECT_NE(std::system(shell.c_str()), 0);
        EXPECT_EQ(names(), before) << signal;
    }
}

#endif

TEST_F(Outputs, NumbersInListsAreWrongUsageWhereTheyAreNone) {
    for (const std::string list : {"nan", "1,nan", "1,,2", "inf", "1e999", "1;2", "x"}) {
        for (const std::string arguments :
             {"accuracy g.hairloom -o f --substeps ", "accuracy g.hairloom -o f --points ",
              "bench place --strands ", "export g.hairloom --format abc -o f.abc --record r --frames ",
              "accuracy g.hairloom -o f --vary airDrag=", "lod g.hairloom -o f --levels cards:",
              "export g.hairloom --format obj-cards -o f.obj --levels ",
              "set g.hairloom -o h.hairloom simulation.gravity=0,",
              "set g.hairloom -o h.hairloom simulation.gravity=",
              "set g.hairloom -o h.hairloom material.rootColour="}) {
            const Outcome outcome = run(arguments + "'" + list + "'");
            EXPECT_EQ(outcome.exitCode, 2) << arguments << list << "\n" << outcome.errors;
            EXPECT_THAT(outcome.errors, testing::StartsWith("error: ")) << arguments << list;
            EXPECT_FALSE(fs::exists(folder / "f")) << arguments << list;
        }
    }
    EXPECT_EQ(run("set g.hairloom layers.None.density=1 -o h.hairloom").exitCode, 1)
        << "another groom may have it";
    EXPECT_EQ(run("set g.hairloom layers.None.density=nan -o h.hairloom").exitCode, 2);
}

TEST_F(Outputs, OptionsThatDoNotGoWithTheOthersAreWrongUsage) {
    const std::pair<const char*, const char*> wrong[] = {
        {"simulate g.hairloom --frames 2 --motion hop",
         "there is no motion 'hop'; expected none, spin, nod, clip:NAME, timeline or a keyframe file"},
        {"simulate g.hairloom --sag --frames 9", "exclude each other"},
        {"simulate g.hairloom --pre-roll 9 --sag", "exclude each other"},
        {"simulate g.hairloom --sag --take -o f.hairloom", "exclude each other"},
        {"render g.hairloom -o f.png --motion hop", "there is no motion 'hop'"},
        {"render g.hairloom -o f.png --frame 3", "--frame needs --record or --motion, because hair rests"},
        {"render g.hairloom -o f.png --frames 0,3", "--motion timeline plays the project's motion"},
        {"effects g.hairloom --motion hop", "there is no motion 'hop'"},
        {"budget g.hairloom --ms 1 --motion hop", "there is no motion 'hop'"},
        {"accuracy g.hairloom -o f --motion hop", "there is no motion 'hop'"},
        {"bench sim --strands 10,5", "--strands has 5 behind 10; expected numbers in ascending order"},
        {"bench sim --strands 5,5", "--strands has 5 behind 5"},
        {"import g.hair -o f.hairloom --scalp all", "--scalp needs --mesh"},
        {"import g.hair -o f.hairloom --turn 90", "--turn needs --mesh"},
        {"import g.hair -o f.hairloom --mesh-up z", "--mesh-up needs --mesh"},
        {"import g.hair -o f.hairloom --mesh-unit cm", "--mesh-unit needs --mesh"},
        {"import g.hair -o f.hairloom --leave-out eyes", "--leave-out needs --mesh"},
        {"export g.hairloom -o f.hair --format hair --levels cards:12@64", "--levels applies to cards alone"},
        {"export g.hairloom -o f.hairrt --format runtime --cards 12", "expected it with --format"},
        {"export g.hairloom -o f.tfx --target tressfx --atlas 512", "--atlas applies to cards alone"},
        {"export g.hairloom -o f --format web --target-px 1", "--target-px applies to cards alone"},
        {"export g.hairloom -o f.glb --format gltf --up z", "do not apply to cards"},
        {"export g.hairloom -o f.hair --format hair --record r --frames 1,3", "hair holds a single pose"}};
    for (const auto& [arguments, words] : wrong) {
        const auto before = names();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments << "\n" << outcome.errors;
        EXPECT_THAT(outcome.errors, testing::StartsWith("error: ")) << arguments;
        EXPECT_THAT(outcome.errors, testing::HasSubstr(words)) << arguments;
        EXPECT_EQ(names(), before) << arguments;
    }
    EXPECT_EQ(run("simulate g.hairloom --frames 2 --motion clip:hop").exitCode, 1) << "a file may have it";
    EXPECT_EQ(run("simulate g.hairloom --frames 2 --motion hop.json").exitCode, 1) << "a file may be there";
}

}  // namespace
}  // namespace hairloom::test
