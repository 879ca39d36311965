// SPDX-License-Identifier: GPL-3.0-or-later
// What every job of docs/cli.md has in common: errors, the unit of what is read, keys of reports.

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

class Contract : public CommandLineTest {
  protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    /// The first bytes of a file under another name.
    void cut(const std::string& from, std::size_t bytes, const std::string& to) const {
        write(to, readText(folder / from).substr(0, bytes));
    }
    /// The parts of the error that `arguments` end with.
    Json errorOf(const std::string& arguments, int exitCode) const {
        const Outcome outcome = run("--json " + arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.errors;
        if (outcome.exitCode == 0) return {};
        return outcome.json()["error"];
    }
};

TEST_F(Contract, ErrorsOfAJobNameAFileAndWhatWasExpected) {
    runJson(createArguments());
    runJson("export hair.hairloom --format ply -o whole.ply");
    runJson("export hair.hairloom --format runtime -o whole.hairrt");
    runJson("export hair.hairloom --format hair -o strands.hair");
    cut("whole.ply", 600, "cut.ply");
    cut("whole.hairrt", 10, "short.hairrt");
    cut("whole.hairrt", 1000, "cut.hairrt");
    cut("hair.hairloom", 5000, "cut.hairloom");
    write("none", "");
    write("empty.json", "{}");
    const std::pair<const char*, const char*> wrong[] = {
        {"stack hair.hairloom --remove 99 -o x.hairloom", "hair.hairloom"},
        {"stack hair.hairloom --solo 99 -o x.hairloom", "hair.hairloom"},
        {"takes hair.hairloom --export nope --format abc -o x.abc", "hair.hairloom"},
        {"takes hair.hairloom --delete nope", "hair.hairloom"},
        {"create --mesh BUST --scalp group:nope --count 9 -o x.hairloom", "BUST"},
        {"create --mesh BUST --scalp cap:0,above:1 --count 9 -o x.hairloom", "BUST"},
        {"import cut.ply -o x.hairloom", "cut.ply"},
        {"import short.hairrt -o x.hairloom", "short.hairrt"},
        {"info cut.hairrt", "cut.hairrt"},
        {"simulate cut.hairrt --frames 1", "cut.hairrt"},
        {"simulate cut.hairloom --frames 1", "cut.hairloom"},
        {"sweep none", "none"},
        {"sweep empty.json", "empty.json"},
        {"groom hair.hairloom --script none -o x.hairloom", "none"},
        {"groom hair.hairloom --script empty.json -o x.hairloom", "empty.json"},
        {"simulate hair.hairloom --motion empty.json --frames 1", "empty.json"},
        {"accuracy hair.hairloom -o x --peers none", "none"},
        {"spheres strands.hair --fit 4 -o x.hairloom", "strands.hair"},
        {"colliders strands.hair --fit spheres -o x.hairloom", "strands.hair"},
        {"colliders strands.hair --fit field -o x.hairloom", "strands.hair"},
    };
    for (const auto& [words, file] : wrong) {
        std::string arguments = words;
        if (const auto at = arguments.find("BUST"); at != std::string::npos)
            arguments.replace(at, 4, "'" + bustFile() + "'");
        const Json error = errorOf(arguments, 1);
        EXPECT_EQ(error["file"], file == std::string("BUST") ? bustFile() : file) << arguments;
        EXPECT_TRUE(error["what"].is_string()) << arguments;
        EXPECT_TRUE(error["expected"].is_string()) << arguments << ": " << error;
    }
    EXPECT_FALSE(fs::exists(folder / "x.hairloom"));
}

#ifndef _WIN32
TEST_F(Contract, AGraphicsApiThatThisMachineLacksIsNamed) {
    runJson(createArguments());
    const Json error = errorOf("simulate hair.hairloom --frames 1 --backend d3d11", 1);
    EXPECT_EQ(error["file"], "hair.hairloom");
    EXPECT_TRUE(error["expected"].is_string());
}
#endif

TEST_F(Contract, AScalpThatIsNoSelectionIsWrongUsage) {
    for (const char* scalp : {"crown", "cap:x", "above:2", "grow:1.5", "all,", "cap:30,edge"}) {
        // Before the head is read.
        const Json error =
            errorOf(std::string("create --mesh none.obj --count 9 -o x.hairloom --scalp ") + scalp, 2);
        EXPECT_THAT(error["what"].get<std::string>(), HasSubstr("selection")) << scalp;
        EXPECT_TRUE(error["expected"].is_string()) << scalp;
        errorOf(std::string("import none.hair --mesh none.obj -o x.hairloom --scalp ") + scalp, 2);
    }
}

TEST_F(Contract, WhatIsNotThereOrUnknownAsksForHairOrMeshes) {
    write("none.hair", "");
    write("poem.txt", "roses are red\n");
    const std::pair<const char*, const char*> wrong[] = {{"nofile.hair", "no such file"},
                                                         {"none.hair", "is empty"},
                                                         {"poem.txt", "is in no format that is known"},
                                                         {".", "is not a regular file"}};
    for (const auto& [file, what] : wrong) {
        for (const char* job : {"info ", "validate "}) {
            const Json error = errorOf(std::string(job) + file, 1);
            EXPECT_EQ(error["file"], file);
            EXPECT_EQ(error["what"], what) << file;
            for (const char* kind : {"project", "hair", "mesh"})
                EXPECT_THAT(error["expected"].get<std::string>(), HasSubstr(kind)) << file;
        }
    }
    write("utf16.obj", std::string("\xff\xfev\0", 4));
    EXPECT_THAT(run("info utf16.obj").errors, HasSubstr("is UTF-16 text"));
}

TEST_F(Contract, EveryJobThatReadsAGroomTakesTheUnitOfFilesWithoutOne) {
    runJson("reference --jobs jobs.json");
    const Json all = Json::parse(readText(folder / "jobs.json"));
    std::set<std::string> with;
    for (const Json& job : all["jobs"]) {
        const auto has = [&](const char* name) {
            return std::ranges::any_of(job["options"],
                                       [&](const Json& option) { return option["name"] == name; });
        };
        EXPECT_TRUE(has("unit") || !has("groom")) << job["name"];
        if (has("unit")) with.insert(job["name"]);
    }
    for (const char* name : {"info", "import", "validate", "simulate", "render", "effects", "groom", "guides",
                             "export", "accuracy", "stack", "takes", "lod", "stability", "budget"})
        EXPECT_TRUE(with.contains(name)) << name;
}

TEST_F(Contract, TheUnitIsOfWhatIsReadAndAnotherOfWhatIsWritten) {
    runJson(createArguments());
    const Json metres = runJson("info hair.hairloom")["bounds"]["max"];
    runJson("export hair.hairloom --format obj-lines --output-unit cm -o cm.obj");
    const auto expectMetres = [&](const std::string& file, const std::string& how) {
        const Json found = runJson("info " + file)["bounds"]["max"];
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(found[i].get<double>(), metres[i].get<double>(), 1e-3) << how;
    };
    EXPECT_GT(runJson("info cm.obj")["bounds"]["max"][1], 50 * metres[1].get<double>())
        << "it states no unit";
    expectMetres("cm.obj --unit cm", "info");
    write("nothing.json", R"({"hairloom_script": 1, "operations": []})");
    for (const std::string job :
         {"guides cm.obj --count 9 --all -o g.hairloom", "groom cm.obj --script nothing.json -o g.hairloom",
          "set cm.obj simulation.substeps=3 -o g.hairloom", "stack cm.obj --bake -o g.hairloom",
          "export cm.obj --format hair -o g.hair"}) {
        runJson(job + " --unit cm --force");
        expectMetres(job.find(".hairloom") != std::string::npos ? "g.hairloom" : "g.hair", job);
    }
    // Both at once.
    runJson("export cm.obj --unit cm --format obj-lines --output-unit cm -o again.obj");
    expectMetres("again.obj --unit cm", "export");
    const Json moved = runJson("simulate cm.obj --unit cm --frames 1");
    EXPECT_EQ(moved["strands"], 300);
    EXPECT_LT(moved["max_stretch"], 0.1);
    EXPECT_EQ(run("export hair.hairloom --format hair --unit parsec -o x.hair").exitCode, 2);
    EXPECT_EQ(run("export hair.hairloom --format hair --output-unit parsec -o x.hair").exitCode, 2);
}

TEST_F(Contract, HairsForUnrealHaveTheirGuidesMarked) {
    runJson(createArguments());
    runJson("set hair.hairloom interpolation.followPerGuide=3 -o hair.hairloom");
    const Json hairs = runJson("export hair.hairloom --what hairs --target unreal -o hairs.abc");
    const Json all = runJson("export hair.hairloom --what all --target unreal -o all.abc");
    EXPECT_GT(hairs["strands"], 300);
    EXPECT_EQ(hairs["strands"], all["strands"]) << "Unreal binds hairs to guides in the same file";
    const auto names = hairs["names"].get<std::set<std::string>>();
    for (const char* name : {"groom_guide", "groom_closest_guides", "groom_guide_weights", "groom_id"})
        EXPECT_TRUE(names.contains(name)) << name;
    const Json alone = runJson("export hair.hairloom --target unreal -o guides.abc");
    EXPECT_EQ(alone["strands"], 300);
    EXPECT_FALSE(alone["names"].get<std::set<std::string>>().contains("groom_guide"));
    EXPECT_FALSE(alone["names"].get<std::set<std::string>>().contains("groom_group_name"))
        << "no layer has a name of its own";
}

TEST_F(Contract, AccuracyHasOtherSimulatorsBeside) {
    runJson(createArguments());
    const std::string grid =
        "accuracy hair.hairloom --frames 2 --strands 4 --substeps 1 --points 6 --repeat 1 "
        "--truth engine --truth-substeps 8 -o ";
    const Json report = runJson(grid + "recorded");
    std::set<std::string> names;
    for (const Json& peer : report["peers"]) {
        names.insert(peer["name"].get<std::string>());
        for (const char* key : {"version", "setting", "machine", "date", "reference"})
            EXPECT_TRUE(peer[key].is_string()) << key;
        for (const char* key : {"ms", "error_mm", "error_mm_max", "cantilever_mm"})
            EXPECT_TRUE(peer[key].is_number()) << key;
    }
    EXPECT_TRUE(names.contains("Hairloom"));
    EXPECT_GE(names.size(), 3u);
    EXPECT_THAT(report["peers_scene"].get<std::string>(), HasSubstr("300"));
    EXPECT_THAT(readText(folder / "recorded" / "report.html"), HasSubstr("Other simulators"));

    write("own.csv",
          "peer,version,setting,strands,ms_per_frame,ms_lowest,ms_highest,error_rms_mm,error_max_mm,"
          "stretch_mean_percent,stretch_max_percent,cantilever_mm,converged,doubt_mm,machine,date,load\n"
          "Knot,1,8 steps,300,1.5,1,2,nan,3,0,0,1,64 steps,0.1,here,2026-01-02,1\n");
    const Json own = runJson(grid + "own --peers own.csv")["peers"];
    ASSERT_EQ(own.size(), 1u);
    EXPECT_EQ(own[0]["name"], "Knot");
    EXPECT_EQ(own[0]["ms"], 1.5);
    EXPECT_TRUE(own[0]["error_mm"].is_null()) << "a run that broke";
    EXPECT_THAT(readText(folder / "own" / "report.html"), HasSubstr("Knot 1"));
}

TEST_F(Contract, TransferAndChartsHaveTheKeysOfTheirRows) {
    runJson(createArguments());
    const Json moved = runJson("transfer hair.hairloom --to '" + bustFile() + "' -o moved.hairloom");
    EXPECT_EQ(moved["layers"], Json::array({"Hair"}));
    EXPECT_TRUE(moved["groups"].is_array());
    EXPECT_TRUE(moved.contains("resampled_fps"));
    const Json chart = runJson("render hair.hairloom --show curves -o curves.png");
    EXPECT_EQ(chart["engine"], "software");
    EXPECT_TRUE(chart["why"].is_string());
}

}  // namespace
}  // namespace hairloom::test
