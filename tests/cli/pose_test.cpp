// SPDX-License-Identifier: GPL-3.0-or-later
// Poses from the command line: made, listed, compared, simulated, keyed.

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class CliPose : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        runJson(createArguments());
        std::ofstream(folder / "lean.json")
            << R"({"hairloom_script": 1, "operations": [{"op": "bend", "sidewaysDegrees": 60}]})";
        runJson("groom hair.hairloom --script lean.json -o bent.hairloom");
        runJson("pose hair.hairloom --name Bent --from bent.hairloom --amount 1 -o posed.hairloom");
    }
    std::string hashOf(const std::string& arguments) {
        return runJson("simulate " + arguments)["state_hash"].get<std::string>();
    }
};

TEST_F(CliPose, AreListedAndCompared) {
    const Json listed = runJson("pose posed.hairloom")["poses"];
    ASSERT_EQ(listed.size(), 1u);
    EXPECT_EQ(listed[0]["name"], "Bent");
    EXPECT_EQ(listed[0]["amount"], 1);
    EXPECT_GT(listed[0]["farthest_mm"], 10);
    EXPECT_EQ(listed[0]["keys"], 0);
    runJson("pose posed.hairloom --name Bent --amount 0.5 --ramp 0,1 --mask 1 --invert -o less.hairloom");
    const Json less = runJson("pose less.hairloom")["poses"][0];
    EXPECT_EQ(less["amount"], 0.5);
    EXPECT_EQ(less["mask"], 1);
    EXPECT_EQ(less["invert"], true);
    const Json differences = runJson("info --diff posed.hairloom less.hairloom")["differences"];
    EXPECT_EQ(differences.size(), 4u) << differences.dump();
    runJson("pose less.hairloom --name Bent --remove -o none.hairloom");
    EXPECT_TRUE(runJson("info --diff hair.hairloom none.hairloom")["differences"].empty());
}

TEST_F(CliPose, HairFollowsThemAndZeroIsNone) {
    const std::string without = hashOf("hair.hairloom --frames 20");
    EXPECT_EQ(hashOf("posed.hairloom --frames 20 --pose Bent=0"), without);
    const std::string with = hashOf("posed.hairloom --frames 20");
    EXPECT_NE(with, without);
    EXPECT_NE(hashOf("posed.hairloom --frames 20 --pose Bent=0.5"), with);
    const Json effects = runJson("simulate posed.hairloom --frames 3")["effects"];
    bool isOn = false;
    for (const Json& effect : effects) isOn |= effect["name"] == "pose" && effect["why"] == "on, amount 1";
    EXPECT_TRUE(isOn) << effects.dump();
}

TEST_F(CliPose, TheTimeLineKeysTheirAmounts) {
    const Json track{{"name", "pose.Bent"},
                     {"keys", {{{"t", 0}, {"value", 0}}, {{"t", 0.25}, {"value", 1}}}}};
    std::ofstream(folder / "line.json")
        << Json{{"time_line", {{"end", 0.5}, {"settings", Json::array({track})}}}}.dump();
    runJson("timeline posed.hairloom --from line.json -o moving.hairloom");
    EXPECT_EQ(runJson("pose moving.hairloom")["poses"][0]["keys"], 2);
    const auto keyable = runJson("timeline moving.hairloom")["keyable"];
    EXPECT_NE(std::find(keyable.begin(), keyable.end(), "pose.Bent"), keyable.end());
    const std::string keyed = hashOf("moving.hairloom --motion timeline");
    EXPECT_NE(keyed, hashOf("posed.hairloom --motion timeline --frames 30"));
    // Keys that hold it at 0 are as no pose.
    const Json zero{{"name", "pose.Bent"}, {"keys", {{{"t", 0}, {"value", 0}}, {{"t", 0.25}, {"value", 0}}}}};
    const Json head{{"t", 0}};
    std::ofstream(folder / "zero.json")
        << Json{{"time_line",
                 {{"end", 0.5}, {"head", Json::array({head})}, {"settings", Json::array({zero})}}}}
               .dump();
    std::ofstream(folder / "end.json")
        << Json{{"time_line", {{"end", 0.5}, {"head", Json::array({head})}}}}.dump();
    runJson("timeline posed.hairloom --from zero.json -o still.hairloom");
    runJson("timeline hair.hairloom --from end.json -o plain.hairloom");
    EXPECT_EQ(hashOf("still.hairloom --motion timeline"), hashOf("plain.hairloom --motion timeline"));
}

TEST_F(CliPose, MistakesAreNamed) {
    EXPECT_THAT(run("pose hair.hairloom --name Wet --amount 1 -o x.hairloom").errors,
                HasSubstr("no pose is called 'Wet'"));
    EXPECT_THAT(run("pose posed.hairloom --name Wet --remove -o x.hairloom").errors,
                HasSubstr("expected one of Bent"));
    EXPECT_THAT(run("simulate posed.hairloom --frames 1 --pose Wet=1").errors,
                HasSubstr("no pose is called 'Wet'"));
    EXPECT_EQ(run("simulate posed.hairloom --frames 1 --pose Bent=2").exitCode, 2);
    EXPECT_EQ(run("simulate posed.hairloom --frames 1 --pose Bent").exitCode, 2);
    EXPECT_EQ(run("pose posed.hairloom --name Bent --amount 2 -o x.hairloom").exitCode, 2);
    EXPECT_EQ(run("pose posed.hairloom --amount 1").exitCode, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "x.hairloom"));
    runJson(createArguments("--force", 7, 6));
    EXPECT_THAT(run("pose posed.hairloom --name Short --from hair.hairloom -o x.hairloom").errors,
                HasSubstr("points; expected 12"));
}

}  // namespace
}  // namespace hairloom::test
