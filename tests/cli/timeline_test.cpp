// SPDX-License-Identifier: GPL-3.0-or-later
// The time line of a project: set, listed and played from the command line.

#include <gmock/gmock.h>

#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::HasSubstr;

constexpr const char* kTurn =
    R"({"keys": [{"t": 0}, {"t": 0.3, "translate": [0.05, 0, 0], "axis": [0, 2, 0], "degrees": 40}],
        "wind": [{"t": 0, "velocity": [2, 0, 0]}, {"t": 0.5, "velocity": [0, 0, 4]}]})";

class CliTimeLine : public CommandLineTest {
  protected:
    void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
    /// moving.hairloom is hair.hairloom with that time line.
    Outcome set(const Json& line, const std::string& more = "") {
        write("line.json", Json{{"time_line", line}}.dump());
        return run("timeline hair.hairloom --from line.json -o moving.hairloom --force --json " + more);
    }
    std::string hashOf(const std::string& arguments) {
        return runJson("simulate " + arguments)["state_hash"].get<std::string>();
    }
};

TEST_F(CliTimeLine, IsSavedListedComparedAndSetAgain) {
    runJson(createArguments());
    const auto empty = runJson("timeline hair.hairloom");
    EXPECT_EQ(empty["time_line"]["framesPerSecond"], 60);
    EXPECT_TRUE(empty["time_line"]["clips"].empty());
    EXPECT_EQ(empty["clips"][0]["name"], "nod_and_turn");
    const Json wind{{"name", "simulation.windSpeed"},
                    {"keys", {{{"t", 0.5}, {"value", 3}, {"interpolate", "smooth"}}}}};
    const Outcome done = set({{"framesPerSecond", 24},
                              {"end", 2},
                              {"preRoll", 3},
                              {"clips", {{{"name", "nod_and_turn"}, {"speed", 0.5}}}},
                              {"settings", Json::array({wind})}});
    ASSERT_EQ(done.exitCode, 0) << done.errors;
    const auto listed = runJson("timeline moving.hairloom --keep kept.json");
    EXPECT_EQ(listed["frames"], 48);
    EXPECT_EQ(listed["time_line"]["clips"][0]["speed"], 0.5);
    EXPECT_EQ(listed["time_line"]["settings"][0]["keys"][0]["interpolate"], "smooth");
    const auto differences = runJson("info --diff hair.hairloom moving.hairloom")["differences"];
    bool told = false;
    for (const auto& difference : differences)
        told |= difference["where"] == "time_line.settings[simulation.windSpeed]";
    EXPECT_TRUE(told) << differences.dump();
    runJson("timeline hair.hairloom --from kept.json -o again.hairloom");
    EXPECT_TRUE(runJson("info --diff moving.hairloom again.hairloom")["differences"].empty());
    // What the job prints is a file for --from as well.
    write("printed.json", run("timeline moving.hairloom --json").output);
    runJson("timeline hair.hairloom --from printed.json -o third.hairloom");
    EXPECT_TRUE(runJson("info --diff moving.hairloom third.hairloom")["differences"].empty());
    const auto played = runJson("simulate moving.hairloom --motion timeline");
    EXPECT_EQ(played["frames"], 48);
    EXPECT_EQ(played["pre_roll"], 3);
    EXPECT_EQ(played["fps"], 24);
}

TEST_F(CliTimeLine, WhatIsSavedHasTheAuthoredSettingsAndNotTheKeyed) {
    runJson(createArguments());
    const Json wind{{"name", "simulation.windSpeed"}, {"keys", {{{"t", 0}, {"value", 7}}}}};
    ASSERT_EQ(set({{"end", 0.1}, {"settings", Json::array({wind})}}).exitCode, 0);
    runJson("simulate moving.hairloom --motion timeline -o after.hairloom");
    const auto differences = runJson("info --diff moving.hairloom after.hairloom")["differences"];
    EXPECT_FALSE(differences.empty()) << "the hair has moved";
    EXPECT_EQ(differences.dump().find("windSpeed"), std::string::npos) << differences.dump();
}

TEST_F(CliTimeLine, AClipAloneMovesHairAsThatClipDoes) {
    runJson(createArguments());
    ASSERT_EQ(set({{"clips", {{{"name", "nod_and_turn"}}}}}).exitCode, 0);
    const std::string more = " --frames 25 --fps 30 --wind 1,0,0 ";
    const std::string clip = hashOf("hair.hairloom --motion clip:nod_and_turn" + more);
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --threads 1" + more), clip);
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --threads 4" + more), clip);
    EXPECT_NE(hashOf("moving.hairloom --motion none" + more), clip);
}

TEST_F(CliTimeLine, KeysOfHeadAndWindMoveHairAsTheirFileDoes) {
    runJson(createArguments());
    write("turn.json", kTurn);
    runJson("timeline hair.hairloom --motion turn.json -o moving.hairloom");
    const std::string file = hashOf("hair.hairloom --motion turn.json --frames 40");
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --frames 40 --threads 1"), file);
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --frames 40 --threads 4"), file);
    runJson("timeline moving.hairloom --keep-motion kept.json");
    EXPECT_EQ(hashOf("hair.hairloom --motion kept.json --frames 40"), file);
    EXPECT_EQ(run("timeline hair.hairloom --keep-motion none.json").exitCode, 1) << "there are no keys";
}

TEST_F(CliTimeLine, KeyedSettingsChangeTheHairFrameByFrame) {
    runJson(createArguments());
    const auto track = [](const char* name, const Json& keys) {
        return Json{{"settings", {{{"name", name}, {"keys", keys}}}}};
    };
    const std::string still = hashOf("hair.hairloom --frames 30");
    // A key that says what the groom says changes no bit.
    ASSERT_EQ(set(track("simulation.windSpeed", {{{"t", 0}, {"value", 0}}})).exitCode, 0);
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --frames 30"), still);
    // One that always says the same is that setting.
    ASSERT_EQ(set(track("simulation.gravity", {{{"t", 0}, {"value", {1, -5, 0}}}})).exitCode, 0);
    runJson("set hair.hairloom 'simulation.gravity=[1,-5,0]' -o leaning.hairloom");
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --frames 30"),
              hashOf("leaning.hairloom --frames 30"));
    // Later keys change nothing before them.
    const Json gust{{{"t", 0.2}, {"value", 0}, {"interpolate", "step"}}, {{"t", 0.25}, {"value", 8}}};
    ASSERT_EQ(set(track("simulation.windSpeed", gust)).exitCode, 0);
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --frames 14"), hashOf("hair.hairloom --frames 14"));
    const std::string blown = hashOf("moving.hairloom --motion timeline --frames 30 --threads 1");
    EXPECT_NE(blown, still);
    EXPECT_EQ(hashOf("moving.hairloom --motion timeline --frames 30 --threads 3"), blown);
    EXPECT_EQ(hashOf("moving.hairloom --frames 30"), still) << "no time line plays unless it is asked for";
}

TEST_F(CliTimeLine, SlowFrameRatesAreStepped) {
    runJson(createArguments());
    ASSERT_EQ(set({{"framesPerSecond", 1}, {"end", 3}, {"clips", {{{"name", "nod_and_turn"}}}}}).exitCode, 0);
    const auto report = runJson("simulate moving.hairloom --motion timeline");
    EXPECT_EQ(report["frames"], 3);
    EXPECT_EQ(report["nan_count"], 0);
    // A frame of a second is ten steps, as ten frames of a tenth are.
    EXPECT_EQ(report["state_hash"], hashOf("hair.hairloom --motion clip:nod_and_turn --fps 10 --frames 30"));
}

TEST_F(CliTimeLine, BlendsFromOneClipIntoAnother) {
    runJson(createArguments());
    const Json first{{"name", "nod_and_turn"}, {"last", 0.5}};
    const Json second{{"name", "nod_and_turn"}, {"start", 0.25}, {"first", 1}, {"blend", 0.5}};
    ASSERT_EQ(set({{"clips", {first, second}}}).exitCode, 0);
    Json hard = second;
    hard["blend"] = 0;
    const auto soft = runJson("simulate moving.hairloom --motion timeline --frames 60");
    EXPECT_EQ(soft["nan_count"], 0);
    ASSERT_EQ(set({{"clips", {first, hard}}}).exitCode, 0);
    EXPECT_NE(soft["state_hash"], hashOf("moving.hairloom --motion timeline --frames 60"));
}

TEST_F(CliTimeLine, RendersAndMeasuresWithIt) {
    runJson(createArguments());
    ASSERT_EQ(set({{"framesPerSecond", 30}, {"clips", {{{"name", "nod_and_turn"}}}}}).exitCode, 0);
    const std::string how = " --frame 12 --engine software --size 48x48 --passes 1 --force -o ";
    runJson("render moving.hairloom --motion timeline" + how + "line.png");
    runJson("render moving.hairloom --motion none" + how + "still.png");
    EXPECT_NE(readText(folder / "line.png"), readText(folder / "still.png"));
    EXPECT_FALSE(runJson("effects moving.hairloom --motion timeline --frames 4")["effects"].empty());
}

TEST_F(CliTimeLine, KeysOfTheMaterialColourHairAndTheSkinBelow) {
    runJson(createArguments());
    const Json grey{0.5, 0.5, 0.5}, blue{0, 0, 1};
    Json tracks = Json::array();
    for (const char* name : {"material.rootColour", "material.tipColour"})
        tracks.push_back(
            {{"name", name}, {"keys", {{{"t", 0}, {"value", grey}}, {{"t", 0.2}, {"value", blue}}}}});
    ASSERT_EQ(set({{"framesPerSecond", 30}, {"end", 0.4}, {"settings", tracks}}).exitCode, 0);
    // A frame has the look that an authored material has there.
    runJson("set hair.hairloom 'material.rootColour=[0,0,1]' 'material.tipColour=[0,0,1]' -o blue.hairloom");
    write("empty.json", Json{{"time_line", {{"framesPerSecond", 30}, {"end", 0.4}}}}.dump());
    runJson("timeline blue.hairloom --from empty.json -o blue.hairloom --force");
    const std::string how = " --engine software --size 64x64 --passes 1 --force -o ";
    const auto picture = [&](const std::string& arguments) {
        runJson("render " + arguments + how + "picture.png");
        return readText(folder / "picture.png");
    };
    const std::string end = picture("moving.hairloom --motion timeline --frame 8");
    EXPECT_EQ(end, picture("blue.hairloom --motion timeline --frame 8"));
    EXPECT_NE(end, picture("moving.hairloom --motion timeline --frame 2"));
    // Of a take of the time line as well, and of no other.
    runJson("takes moving.hairloom --record line --motion timeline --frames 9");
    EXPECT_EQ(picture("moving.hairloom --record moving.takes/line.hltake --frame 8"),
              picture("blue.hairloom --record moving.takes/line.hltake --frame 8"));
    runJson("simulate moving.hairloom --motion timeline --frames 9 --record line.frames");
    EXPECT_NE(picture("moving.hairloom --record line.frames --frame 8"),
              picture("blue.hairloom --record line.frames --frame 8"));
    const Outcome streaks =
        set({{"settings", {{{"name", "material.streakShare"}, {"keys", {{{"t", 0}, {"value", 0.5}}}}}}}});
    EXPECT_EQ(streaks.exitCode, 1);
    EXPECT_THAT(streaks.errors, HasSubstr("cannot be keyed"));
}

TEST_F(CliTimeLine, WhatCannotPlayIsRefusedWithItsPlace) {
    runJson(createArguments());
    const auto settings = [](const char* name, const Json& key) {
        return Json{{"settings", {{{"name", name}, {"keys", Json::array({key})}}}}};
    };
    const Json clip{{"name", "nod_and_turn"}};
    const auto with = [](Json one, const char* member, const Json& value) {
        one[member] = value;
        return one;
    };
    const std::pair<Json, const char*> wrong[] = {
        {{{"clips", {{{"name", "dance"}}}}}, "/clips/0/name: the character has no clip 'dance'"},
        {{{"clips", Json::array({with(clip, "first", 99)})}}, "/clips/0/first is 99 s"},
        {{{"clips", Json::array({with(clip, "last", 99)})}}, "/clips/0/last is 99 s"},
        {{{"clips", Json::array({with(with(clip, "first", 1), "last", 0.5)})}}, "/clips/0/last is 0.5 s"},
        {{{"clips", Json::array({with(clip, "blend", 1)})}}, "/clips/0/blend is 1 s"},
        {{{"clips", {clip, clip}}}, "/clips/1/start is 0 s, not later"},
        {{{"clips", Json::array({with(clip, "speed", -1)})}}, "/clips/0/speed is -1"},
        {{{"start", 3}, {"end", 1}}, "/end is 1 s; expected more than start, 3 s"},
        {{{"end", 900000}}, "/end is 900000 s; expected at most 1000000 frames"},
        {{{"framesPerSecond", 0}}, "/framesPerSecond is 0"},
        {{{"framesPerSecond", 241}}, "/framesPerSecond is 241"},
        {{{"framesPerSecond", "fast"}}, "/framesPerSecond is \"fast\""},
        {{{"preRoll", -1}}, "/preRoll is -1"},
        {{{"head", {{{"t", 1}}, {{"t", 1}}}}}, "/head/1/t is 1 s, not later than the key before it"},
        {{{"head", {{{"t", -1}}}}}, "/head/0/t is -1"},
        {{{"head", {{{"t", 0}, {"axis", {0, 0, 0}}}}}}, "/head/0/axis has no direction"},
        {{{"wind", {{{"t", 0}, {"velocity", {900, 900, 0}}}}}}, "/wind/0/velocity is too fast"},
        {settings("simulation.angularCurve", {{"t", 0}, {"value", 1}}),
         "/settings/0/name is \"simulation.angularCurve\", which cannot be keyed"},
        {settings("simulation.strandModel", {{"t", 0}, {"value", "rods"}}), "which cannot be keyed"},
        {settings("material.greyShare", {{"t", 0}, {"value", 1}}), "which cannot be keyed"},
        {settings("simulation.windSpeed", {{"t", 0}, {"value", 900}}), "/settings/0/keys/0/value is 900"},
        {settings("simulation.windKind", {{"t", 0}, {"value", "uniform"}, {"interpolate", "linear"}}),
         "/settings/0/keys/0/interpolate is \"linear\"; expected \"step\""},
        {settings("simulation.windSpeed", {{"t", 0}, {"value", 1}, {"interpolate", "wild"}}),
         "/settings/0/keys/0/interpolate is \"wild\""},
        {{{"colour", 1}}, "/colour is not known"},
    };
    for (const auto& [line, expected] : wrong) {
        const Outcome refused = set(line);
        EXPECT_EQ(refused.exitCode, 1) << line.dump();
        EXPECT_THAT(refused.errors + refused.output, HasSubstr(expected)) << line.dump();
        EXPECT_FALSE(fs::exists(folder / "moving.hairloom")) << line.dump();
    }
    EXPECT_EQ(run("timeline hair.hairloom --from none.json -o x.hairloom").exitCode, 1);
    EXPECT_EQ(run("timeline hair.hairloom --from line.json").exitCode, 2) << "without an output";
    // A clip of a head that has gone is told when it is to play.
    runJson("create --mesh '" + bustFile() +
            "' --scalp material:scalp --count 20 --placement dart --length 0.1 --points 6 -o few.hairloom");
    write("line.json", Json{{"time_line", {{"clips", Json::array({clip})}}}}.dump());
    const Outcome lost = run("timeline few.hairloom --from line.json --character gone.glb -o x.hairloom");
    EXPECT_EQ(lost.exitCode, 1);
    EXPECT_THAT(lost.errors, HasSubstr("gone.glb"));
}

}  // namespace
}  // namespace hairloom::test
