// SPDX-License-Identifier: GPL-3.0-or-later
// `info --diff`: what changed between two versions of a groom.

#include <gmock/gmock.h>

#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class CliComparison : public CommandLineTest {
  protected:
    std::vector<std::string> words(const std::string& files) const {
        std::vector<std::string> all;
        const auto report = runJson("info --diff " + files);
        for (const auto& row : report["differences"]) all.push_back(row["words"]);
        return all;
    }
};

TEST_F(CliComparison, TellsWhatASettingAScriptAndAStackChanged) {
    runJson(createArguments());
    EXPECT_EQ(runJson("info --diff hair.hairloom hair.hairloom")["differences"], nlohmann::json::array());
    EXPECT_THAT(run("info --diff hair.hairloom hair.hairloom").output,
                AllOf(HasSubstr("no differences between hair.hairloom and hair.hairloom\n"),
                      HasSubstr("differences: none\n")));

    runJson("set hair.hairloom simulation.substeps=5 material.rootRadius=0.00005 -o set.hairloom");
    const auto set = runJson("info --diff hair.hairloom set.hairloom");
    ASSERT_EQ(set["differences"].size(), 2u) << set.dump(1);
    EXPECT_EQ(set["strands_matched_by"], "ids");
    EXPECT_EQ(set["compared"], "all");
    for (const auto& row : set["differences"]) {
        for (const char* key : {"where", "what", "before", "after"}) EXPECT_TRUE(row.contains(key)) << row;
        EXPECT_EQ(row["what"], "changed");
        if (row["where"] == "simulation.substeps") {
            EXPECT_EQ(row["after"], 5);
        } else {
            EXPECT_EQ(row["where"], "material.rootRadius");
            EXPECT_EQ(row["unit"], "m");
        }
    }
    EXPECT_THAT(run("info --diff hair.hairloom set.hairloom").output,
                testing::ContainsRegex("  simulation\\.substeps: [0-9]+ → 5\n"));

    std::ofstream(folder / "trim.json") << R"({"hairloom_script": 1, "operations": [
        {"op": "set_length", "length": 0.1}]})";
    runJson("groom hair.hairloom --script trim.json -o short.hairloom");
    EXPECT_THAT(words("hair.hairloom short.hairloom"),
                testing::Contains(StartsWith("strands: all 300 strands moved, by up to 100 mm")));

    std::ofstream(folder / "stack.json") << R"({"operators": [{"op": "clump", "weight": 0.5}]})";
    runJson("stack hair.hairloom --from stack.json -o a.hairloom");
    std::ofstream(folder / "stack.json")
        << R"({"operators": [{"op": "noise", "weight": 0}, {"op": "clump", "weight": 0.25}]})";
    runJson("stack hair.hairloom --from stack.json -o b.hairloom");
    EXPECT_THAT(words("a.hairloom b.hairloom"),
                AllOf(testing::Contains("operators[1 clump].weight: 0.5 → 0.25"),
                      testing::Contains(StartsWith("operators[0 noise]: added {\"op\":\"noise\""))));
}

TEST_F(CliComparison, ComparesAssetsHairFilesAndHeads) {
    runJson(createArguments());
    runJson("set hair.hairloom simulation.substeps=5 -o set.hairloom");
    runJson("export hair.hairloom --format runtime -o a.hairrt");
    runJson("export set.hairloom --format runtime -o b.hairrt");
    EXPECT_THAT(words("a.hairrt a.hairrt"), testing::IsEmpty());
    EXPECT_THAT(words("a.hairrt b.hairrt"), AllOf(testing::Contains(StartsWith("simulation.substeps: ")),
                                                  testing::Contains(StartsWith("asset.sections."))));

    // Of a project and a file that holds strands alone, strands are compared.
    runJson("export hair.hairloom --format ply -o hair.ply");
    const auto mixed = runJson("info --diff hair.hairloom hair.ply");
    EXPECT_EQ(mixed["compared"], "hair");
    EXPECT_EQ(mixed["strands_matched_by"], "order");
    for (const auto& row : mixed["differences"]) {
        EXPECT_THAT(row["where"].get<std::string>(),
                    testing::AnyOf(StartsWith("strands"), StartsWith("points")));
        EXPECT_EQ(row["what"], "removed") << row;
    }
    EXPECT_THAT(mixed["summary"], HasSubstr(" in strands and their attributes between"));

    EXPECT_THAT(words("'" + bustFile() + "' '" + bustFile() + "'"), testing::IsEmpty());
    EXPECT_THAT(words("hair.ply '" + bustFile() + "'"),
                testing::Contains("strands: 300 strands removed (300 → 0)"));
}

TEST_F(CliComparison, RefusesWrongUsageAndDamage) {
    runJson(createArguments());
    for (const char* wrong :
         {"info", "info --diff hair.hairloom", "info hair.hairloom --diff hair.hairloom hair.hairloom",
          "info --diff hair.hairloom hair.hairloom hair.hairloom"})
        EXPECT_EQ(run(wrong).exitCode, 2) << wrong;
    const std::string whole = readText(folder / "hair.hairloom");
    std::ofstream(folder / "torn.hairloom", std::ios::binary) << whole.substr(0, whole.size() / 2);
    for (const char* bad : {"torn.hairloom", "missing.hairloom"}) {
        const auto second = run(std::string("info --diff hair.hairloom ") + bad);
        EXPECT_EQ(second.exitCode, 1);
        EXPECT_THAT(second.errors, HasSubstr(bad));
        EXPECT_EQ(run(std::string("info --diff ") + bad + " hair.hairloom").exitCode, 1);
    }
}

TEST_F(CliComparison, FindsTheSameHeadInFoldersOfVersions) {
    std::filesystem::create_directories(folder / "v1");
    std::filesystem::create_directories(folder / "v2");
    for (const char* version : {"v1", "v2"}) {
        std::filesystem::copy_file(bustFile(),
                                   folder / version / std::filesystem::path(bustFile()).filename());
        runJson(std::string("create --mesh ") + version + "/" +
                std::filesystem::path(bustFile()).filename().string() +
                " --scalp material:scalp --count 30 --length 0.2 --points 8 --seed 1 -o " + version +
                "/hair.hairloom");
    }
    EXPECT_THAT(words("v1/hair.hairloom v2/hair.hairloom"), testing::IsEmpty());
}

}  // namespace
}  // namespace hairloom::test
