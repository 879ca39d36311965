// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as docs/cli.md promises it, on the sample head.

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class Cli : public CommandLineTest {
  protected:
    std::size_t filesInFolder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
};

TEST_F(Cli, WrongUsageEndsWith2AndHelpWith0) {
    EXPECT_EQ(run("").exitCode, 2);
    EXPECT_EQ(run("braid hair.hairloom").exitCode, 2);
    EXPECT_EQ(run("create --mesh x.obj --count minus -o g").exitCode, 2);
    EXPECT_EQ(run("create --mesh x.obj -o g").exitCode, 2) << "neither count nor density";
    EXPECT_EQ(run("--help").exitCode, 0);
}

TEST_F(Cli, UsageErrorsSayWhatWouldWork) {
    const std::pair<const char*, const char*> wrong[] = {
        {"", "error: a job is required; see hairloom-cli --help\n"},
        {"smulate hair.hairloom", "error: there is no job 'smulate'; did you mean simulate?\n"},
        {"simulate x --substep 3", "error: there is no option --substep; did you mean --substeps?\n"},
        {"simulate x --frobnicate=3",
         "error: there is no option --frobnicate=3; see hairloom-cli simulate --help\n"},
        {"simulate x y", "error: unexpected argument 'y'; see hairloom-cli simulate --help\n"},
        {"simulate x --method strand",
         "error: --method is 'strand'; expected one of strands, projective, chain, lattice, particles, "
         "hybrid (did you mean "
         "strands?)\n"},
        {"simulate x --frames 0", "error: --frames is '0'; expected 1 to 1000000\n"},
        {"simulate x --frames", "error: --frames has no value; expected 1 to 1000000\n"},
        {"simulate x --frames ten", "error: --frames is 'ten'; expected 1 to 1000000\n"},
        {"simulate --motoin nod", "error: there is no option --motoin; did you mean --motion?\n"},
        {"simulate", "error: groom is required; see hairloom-cli simulate --help\n"},
        {"devices extra", "error: unexpected argument 'extra'; see hairloom-cli devices --help\n"},
        {"budget x", "error: an option is missing; expected one of --ms, --within-mm\n"},
        {"budget x --ms 4 --within-mm 1",
         "error: options exclude each other; expected one of --ms, --within-mm\n"},
        {"groom x", "error: groom, --script and -o are required; see hairloom-cli groom --help\n"},
        {"simulate x --record",
         "error: --record has no value; expected a value: File for all frames, or a take where it ends in "
         ".hltake\n"},
    };
    for (const auto& [arguments, message] : wrong) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 2) << arguments;
        EXPECT_EQ(outcome.errors, message) << arguments;
        EXPECT_EQ(outcome.output, "") << arguments;
        const auto error = run("--json " + std::string(arguments)).json()["error"];
        EXPECT_EQ(
            "error: " + error["what"].get<std::string>() + "; " + error["expected"].get<std::string>() + "\n",
            message);
    }
    runJson(createArguments());
    EXPECT_THAT(run("simulate hair.hairloom --motion jump").errors, HasSubstr("clip:NAME"));
}

std::size_t longestLine(const std::string& text) {
    std::istringstream lines(text);
    std::size_t longest = 0;
    for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
    return longest;
}

TEST_F(Cli, EveryJobHasHelpWithAnExample) {
    const std::string help = run("--help").output;
    std::istringstream lines(help.substr(help.find("Subcommands:")));
    std::string line;
    std::getline(lines, line);
    std::size_t jobs = 0;
    for (; std::getline(lines, line) && line.starts_with("  "); ++jobs) {
        const std::string job = line.substr(2, line.find(' ', 2) - 2);
        const Outcome jobHelp = run(job + " --help");
        EXPECT_EQ(jobHelp.exitCode, 0) << job;
        EXPECT_THAT(jobHelp.output, HasSubstr("hairloom-cli " + job));
        EXPECT_LE(longestLine(jobHelp.output), 100u) << job;
    }
    EXPECT_GE(jobs, 16u);
    EXPECT_LE(longestLine(help), 100u);
    EXPECT_LE(std::ranges::count(help, '\n'), 50) << "it fits a screen";
}

TEST_F(Cli, CreateReportsItsResult) {
    const auto report = runJson(createArguments());
    EXPECT_EQ(report["strands"], 300);
    EXPECT_EQ(report["points"], 300 * 12);
    EXPECT_GT(report["scalp_area_cm2"], 300.0);
    EXPECT_GT(report["min_root_distance"], 0.003);
    EXPECT_GT(report["triangles"], 300);
    EXPECT_GT(report["relative_radius"], 0.7) << "maximal and even";
    EXPECT_LT(report["relative_radius"], 0.85);
    const auto info = runJson("info hair.hairloom");
    EXPECT_EQ(info["strands"], 300);
    EXPECT_EQ(info["guides"], 300);
    EXPECT_EQ(info["format"], "hairloom");
    const auto validated = runJson("validate hair.hairloom");
    EXPECT_TRUE(validated["valid"].get<bool>()) << validated.dump(2);
}

TEST_F(Cli, SameSeedSameBytesForAnyNumberOfThreads) {
    runJson(createArguments("--threads 1"));
    const std::string one = readText(folder / "hair.hairloom");
    runJson(createArguments("--threads 4"));
    EXPECT_EQ(one, readText(folder / "hair.hairloom"));
    runJson(createArguments("", 8));
    EXPECT_NE(one, readText(folder / "hair.hairloom"));
}

TEST_F(Cli, ErrorsNameFileAndExpectationAndLeaveNothingBehind) {
    const Outcome missing = run("create --mesh none.obj --count 10 -o hair.hairloom");
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_THAT(missing.errors, StartsWith("error: none.obj: "));
    const Outcome group =
        run("create --mesh '" + bustFile() + "' --scalp group:beard --count 10 -o hair.hairloom");
    EXPECT_EQ(group.exitCode, 1);
    EXPECT_THAT(group.errors, HasSubstr("scalp")) << "the groups there are";
    const Outcome dense =
        run("create --mesh '" + bustFile() + "' --scalp material:scalp --density 1e9 -o hair.hairloom");
    EXPECT_EQ(dense.exitCode, 1);
    EXPECT_THAT(dense.errors, HasSubstr("cm²"));
    EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(Cli, ADamagedProjectIsRefusedWithThePlace) {
    runJson(createArguments());
    std::string bytes = readText(folder / "hair.hairloom");
    bytes[bytes.size() - 40] = static_cast<char>(bytes[bytes.size() - 40] ^ 0x10);
    std::ofstream(folder / "hair.hairloom", std::ios::binary) << bytes;
    const Outcome damaged = run("info hair.hairloom");
    EXPECT_EQ(damaged.exitCode, 1);
    EXPECT_THAT(damaged.errors, StartsWith("error: hair.hairloom"));
}

TEST_F(Cli, ExportedAssetsComeBackTheSame) {
    runJson(createArguments("", 7, 16));
    for (const char* format : {"hair", "tfx"}) {
        const std::string name = std::string("hair.") + format;
        const auto exported = runJson(std::string("export hair.hairloom --format ") + format + " -o " + name);
        EXPECT_EQ(exported["strands"], 300) << format;
        EXPECT_EQ(exported["bytes"], fs::file_size(folder / name)) << format;
        EXPECT_LT(exported["max_error_mm"], 1e-3) << format;
        EXPECT_TRUE(fs::exists(folder / (name + ".report.json"))) << format;
        const auto back = runJson("import " + name + " -o back.hairloom");
        EXPECT_EQ(back["strands"], 300) << format;
        EXPECT_TRUE(back["dropped"].empty()) << format;
    }
}

TEST_F(Cli, ProfileSaysWhatPartsTook) {
    const Outcome profiled = run(createArguments("--json --profile"));
    EXPECT_EQ(profiled.exitCode, 0);
    EXPECT_THAT(profiled.errors, HasSubstr("groom: save project"));
    EXPECT_EQ(profiled.json()["strands"], 300) << "nothing of it on standard output";
    EXPECT_EQ(run(createArguments()).errors.find("groom: save project"), std::string::npos);
}

TEST_F(Cli, FollowHairsAreExportedWhenAskedFor) {
    runJson(createArguments("", 7, 16));
    runJson("set hair.hairloom interpolation.followPerGuide=5 -o full.hairloom");
    const auto guides = runJson("export full.hairloom --format hair -o guides.hair");
    EXPECT_EQ(guides["strands"], 300);
    const auto saysThatHairsStay = [](const nlohmann::json& report) {
        return report["findings"].dump().find("5 follow hairs per guide are left out") != std::string::npos;
    };
    EXPECT_TRUE(saysThatHairsStay(guides)) << guides.dump(2);
    const auto hairs = runJson("export full.hairloom --format hair --what hairs -o hairs.hair");
    EXPECT_EQ(hairs["strands"], 300 * 5);
    EXPECT_FALSE(saysThatHairsStay(hairs)) << hairs.dump(2);
    EXPECT_LT(hairs["max_error_mm"], 1e-3);
    EXPECT_EQ(runJson("import hairs.hair -o back.hairloom")["strands"], 300 * 5);
    EXPECT_EQ(runJson("export hair.hairloom --format hair --what hairs -o same.hair")["strands"], 300)
        << "without follow hairs the strands are what pictures show";
}

TEST_F(Cli, RenderWritesAPictureAndReportsCosts) {
    runJson(createArguments());
    const auto report = runJson("render hair.hairloom -o hair.png --size 160x120 --camera front");
    EXPECT_FALSE(report["device"].get<std::string>().empty());
    EXPECT_EQ(report["hairs"], 300);
    EXPECT_FALSE(report["passes"].empty());
    const std::string picture = readText(folder / "hair.png");
    EXPECT_THAT(picture, StartsWith("\x89PNG"));
    EXPECT_GT(picture.size(), 2000u);
}

TEST_F(Cli, HairIsShadedByTheModelThatIsAskedFor) {
    runJson(createArguments());
    std::ofstream(folder / "blond.json") << R"({"hair": {"radius_m": 0.0005, "eumelanin": 0.1}})";
    std::ofstream(folder / "black.json")
        << R"({"hair": {"radius_m": 0.0005, "sigma_a_per_radius": [3, 5, 9]}})";
    std::ofstream(folder / "wrong.json") << R"({"hair": {"eumelanine": 0.1}})";
    std::set<std::string> pictures;
    for (const std::string how :
         {"--shading kajiya", "--shading marschner", "--shading marschner --scatter single",
          "--shading sadeghi", "--shading sadeghi --scatter single",
          "--shading marschner --view black.json"}) {
        const std::string view = how.find("--view") == std::string::npos ? " --view blond.json" : "";
        runJson("render hair.hairloom -o hair.png --size 96x96 --passes 1 " + how + view);
        pictures.insert(readText(folder / "hair.png"));
    }
    EXPECT_EQ(pictures.size(), 6u);
    // Though grown strands have radii of their own.
    std::ofstream(folder / "thin.json") << R"({"hair": {"radius_m": 0.00005, "eumelanin": 0.1}})";
    runJson("render hair.hairloom -o hair.png --size 96x96 --passes 1 --shading kajiya --view thin.json");
    EXPECT_FALSE(pictures.contains(readText(folder / "hair.png")));
    const Outcome wrong = run("render hair.hairloom -o none.png --shading marschner --view wrong.json");
    EXPECT_EQ(wrong.exitCode, 1);
    EXPECT_THAT(wrong.errors, HasSubstr("eumelanine"));
}

TEST_F(Cli, HiddenGroupsAreLeftOutOfThePicture) {
    std::ofstream(folder / "two.obj") << "g head\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n"
                                         "g helper-a\nv 0 .1 0\nv 0 .1 1\nv 1 .1 1\nf 5 6 7\n"
                                         "g helper-b\nv 0 9 0\nv 0 9 1\nv 1 9 1\nf 8 9 10\n";
    std::ofstream(folder / "one.obj") << "g head\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n";
    for (const std::string name : {"one", "two"}) {
        runJson("create --mesh " + name + ".obj --scalp group:head --count 20 --length 0.2 -o " + name +
                ".hairloom");
    }
    const auto picture = [&](const std::string& arguments) {
        runJson("render " + arguments + " -o picture.png --size 96x96 --passes 1");
        return readText(folder / "picture.png");
    };
    EXPECT_NE(picture("two.hairloom"), picture("one.hairloom"));
    EXPECT_EQ(picture("two.hairloom --hide 'helper-*'"), picture("one.hairloom"));
    EXPECT_EQ(picture("two.hairloom --hide helper-a,helper-b"), picture("one.hairloom"));
    const Outcome unknown = run("render two.hairloom --hide helper-c -o none.png");
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.errors, HasSubstr("no group 'helper-c'; expected one of: head, helper-a, helper-b"));
    EXPECT_FALSE(fs::exists(folder / "none.png"));
}

}  // namespace
}  // namespace hairloom::test
