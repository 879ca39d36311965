// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs that change a project: settings by name, presets, scripts and the stack.

#include <gmock/gmock.h>

#include <fstream>
#include <map>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class CliSettings : public CommandLineTest {};

TEST_F(CliSettings, AStrokeOfDyeIsReplayed) {
    runJson(createArguments());
    std::ofstream(folder / "dye.json") << R"({"hairloom_script": 1, "operations": [{"op": "stroke",
        "tool": "dye_paint", "radius": 0.5, "profile": [0, 1], "falloff": [],
        "dabs": [{"at": [0, 1.7, 0], "strength": 1}]}]})";
    const auto first = runJson("groom hair.hairloom --script dye.json -o dyed.hairloom");
    EXPECT_EQ(first["strokes"], 1);
    EXPECT_EQ(first["touched_strands"], 0) << "none has moved";
    runJson("groom hair.hairloom --script dye.json -o again.hairloom --threads 4");
    EXPECT_EQ(readText(folder / "dyed.hairloom"), readText(folder / "again.hairloom"));
    EXPECT_NE(readText(folder / "dyed.hairloom").find("\"point/dye\""), std::string::npos);
    EXPECT_TRUE(runJson("validate dyed.hairloom")["valid"].get<bool>());
}

TEST_F(CliSettings, StiffnessComesFromAPaintedMaskAndMoves) {
    runJson(createArguments());
    std::ofstream(folder / "paint.json") << R"({"hairloom_script": 1, "operations": [
        {"op": "mask_names", "names": {"1": "Gel"}}, {"op": "stroke", "tool": "mask_paint", "radius": 0.15,
        "profile": [1, 1], "falloff": [], "dabs": [{"at": [0.15, 1.75, 0], "strength": 1}]}]})";
    runJson("groom hair.hairloom --script paint.json -o painted.hairloom");
    EXPECT_EQ(
        runJson(
            "set painted.hairloom --stiffness-mask gel --stiffness-range 0.25,8 -o gel.hairloom")["changed"],
        1);
    EXPECT_TRUE(runJson("validate gel.hairloom")["valid"].get<bool>());
    EXPECT_NE(readText(folder / "gel.hairloom").find("\"strand/stiffness\""), std::string::npos);
    const auto hashOf = [&](const std::string& file) {
        return runJson("simulate " + file + " --frames 20 --motion nod --engine cpu")["state_hash"];
    };
    const auto even = hashOf("painted.hairloom"), gel = hashOf("gel.hairloom");
    EXPECT_NE(gel, even);
    // A game's file keeps it.
    runJson("export gel.hairloom --format runtime -o gel.hairrt");
    runJson("export painted.hairloom --format runtime -o painted.hairrt");
    EXPECT_EQ(runJson("info gel.hairrt")["asset"]["version"], "1.6");
    EXPECT_EQ(runJson("info painted.hairrt")["asset"]["version"], "1.4");
    EXPECT_NE(hashOf("gel.hairrt"), hashOf("painted.hairrt"));
    EXPECT_EQ(runJson("set gel.hairloom --even-stiffness -o even.hairloom")["changed"], 1);
    EXPECT_EQ(hashOf("even.hairloom"), even);
    EXPECT_EQ(readText(folder / "even.hairloom"), readText(folder / "painted.hairloom"));
    // From an attribute, as it is.
    runJson("set gel.hairloom --stiffness-attribute stiffness -o again.hairloom");
    EXPECT_EQ(readText(folder / "again.hairloom"), readText(folder / "gel.hairloom"));

    const auto refused = [&](const std::string& options, int exitCode, const std::string& words) {
        const Outcome outcome = run("set painted.hairloom " + options + " -o none.hairloom");
        EXPECT_EQ(outcome.exitCode, exitCode) << options;
        EXPECT_THAT(outcome.errors, HasSubstr(words)) << options;
        EXPECT_FALSE(std::filesystem::exists(folder / "none.hairloom")) << options;
    };
    refused("--stiffness-mask Fringe", 1, "Fringe");
    refused("--stiffness-mask Fringe", 1, "painted.hairloom");
    refused("--stiffness-mask 2", 1, "nothing is painted in mask 'Mask 2'");
    refused("--stiffness-attribute depth", 1, "there is no strand attribute 'depth'");
    refused("--stiffness-image none.png", 1, "none.png");
    refused("--stiffness-range 1,2", 2, "expected --stiffness-image or --stiffness-mask");
    refused("--stiffness-mask 1 --stiffness-range 1,1001", 2, "1000");
    refused("--stiffness-mask 1 --stiffness-range 1,nan", 2, "nan");
    refused("--stiffness-mask 1 --stiffness-range 1", 2, "stiffness-range");
    refused("--stiffness-mask 1 --even-stiffness", 2, "even-stiffness");
}

TEST_F(CliSettings, AFullHeadIsAsDenseAsAPersons) {
    const double area = runJson(createArguments())["scalp_area_cm2"];
    EXPECT_EQ(runJson("set hair.hairloom --full-head -o full.hairloom")["changed"], 2) << "hairs and blend";
    const auto follow = [&](const std::string& file) {
        std::map<std::string, double> values;
        const auto report = runJson("info --diff hair.hairloom " + file);
        for (const auto& row : report["differences"]) values[row["where"]] = row["after"].get<double>();
        return values;
    };
    auto full = follow("full.hairloom");
    EXPECT_NEAR(full["interpolation.followPerGuide"], 160 * area / 300, 1);
    EXPECT_EQ(full["interpolation.blend"], 1);
    runJson("set hair.hairloom --full-head interpolation.followPerGuide=5 -o few.hairloom");
    EXPECT_EQ(follow("few.hairloom")["interpolation.followPerGuide"], 5);
    std::ofstream(folder / "loose.obj") << "v 0 0 0\nv 0 1 0\nl 1 2\n";
    const Outcome none = run("set loose.obj --full-head -o none.hairloom");
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.errors, HasSubstr("no scalp is selected"));
}

TEST_F(CliSettings, AStackIsShownSetChangedAndBaked) {
    runJson(createArguments());
    EXPECT_TRUE(runJson("stack hair.hairloom")["operators"].empty());
    std::ofstream(folder / "stack.json") << R"({"operators": [
        {"op": "flow", "gravity": 0.9}, {"op": "clump", "weight": 0.5}, {"op": "noise", "enabled": false}]})";
    const auto made = runJson("stack hair.hairloom --from stack.json -o styled.hairloom");
    ASSERT_EQ(made["operators"].size(), 3u);
    EXPECT_FLOAT_EQ(made["operators"][0]["gravity"], 0.9f);
    EXPECT_TRUE(made["operators"][1].contains("spacing")) << "all settings are written out";
    EXPECT_TRUE(runJson("validate styled.hairloom")["valid"].get<bool>());
    // What the job prints is what it takes.
    std::ofstream(folder / "again.json") << nlohmann::json{{"operators", made["operators"]}}.dump();
    runJson("stack hair.hairloom --from again.json -o again.hairloom --threads 1");
    EXPECT_EQ(readText(folder / "styled.hairloom"), readText(folder / "again.hairloom"));
    // An empty stack leads back to the base shape.
    std::ofstream(folder / "none.json") << R"({"operators": []})";
    runJson("stack styled.hairloom --from none.json -o bare.hairloom");
    EXPECT_EQ(readText(folder / "bare.hairloom"), readText(folder / "hair.hairloom"));
    // Baked, the hair stays as it is.
    runJson("stack styled.hairloom --bake -o baked.hairloom");
    EXPECT_TRUE(runJson("stack baked.hairloom")["operators"].empty());
    runJson("export styled.hairloom --format ply -o styled.ply");
    runJson("export baked.hairloom --format ply -o baked.ply");
    EXPECT_EQ(readText(folder / "styled.ply"), readText(folder / "baked.ply"));
}

TEST_F(CliSettings, AStackThatCannotBeIsRefusedWithItsPlace) {
    runJson(createArguments());
    std::ofstream(folder / "stack.json")
        << R"({"operators": [{"op": "flow"}, {"op": "clump", "spacing": -1}]})";
    const Outcome outcome = run("stack hair.hairloom --from stack.json -o out.hairloom");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.errors, StartsWith("error: stack.json"));
    EXPECT_THAT(outcome.errors, HasSubstr("/operators/1/spacing"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.hairloom"));
    EXPECT_EQ(run("stack hair.hairloom --bake").exitCode, 2) << "needs -o";
}

TEST_F(CliSettings, SettingsAreCheckedByNameAndRange) {
    runJson(createArguments());
    const auto set =
        runJson("set hair.hairloom simulation.windSpeed=4 material.shininess=90 -o hair.hairloom");
    EXPECT_EQ(set["changed"], 2);
    const Outcome range = run("set hair.hairloom simulation.friction=7 -o hair.hairloom");
    EXPECT_EQ(range.exitCode, 2);
    EXPECT_THAT(range.errors, HasSubstr("0 to 1"));
    const Outcome name = run("set hair.hairloom simulation.wobble=1 -o hair.hairloom");
    EXPECT_EQ(name.exitCode, 2);
    EXPECT_THAT(name.errors, HasSubstr("friction")) << "the fields there are";
}

TEST_F(CliSettings, SettingsAreKnownByTheirFormerNames) {
    runJson(createArguments());
    const auto hashWith = [&](const std::string& settings) {
        runJson("set hair.hairloom " + settings + " -o named.hairloom");
        return readText(folder / "named.hairloom");
    };
    const std::string now = hashWith(
        "simulation.collisionRadiusRoot=0.002 simulation.collisionRadiusTip=0.006 "
        "simulation.angularMethod=smallAngle material.colourSource=colours");
    EXPECT_EQ(hashWith("simulation.pearlRadiusRoot=0.002 simulation.pearlRadiusTip=0.006 "
                       "simulation.angularMethod=cheap material.dyed=true"),
              now);
    EXPECT_NE(now.find("collisionRadiusTip"), std::string::npos);
    EXPECT_EQ(now.find("pearl"), std::string::npos) << "what is written has the names of now";

    std::ofstream(folder / "former.json") << R"({"hairloom_script": 1, "operations": [
        {"op": "simulation", "settings": {"pearlRadiusTip": 0.004, "angularMethod": "cheap"}},
        {"op": "placement", "settings": {"darts": false}}]})";
    std::ofstream(folder / "now.json") << R"({"hairloom_script": 1, "operations": [
        {"op": "simulation", "settings": {"collisionRadiusTip": 0.004, "angularMethod": "smallAngle"}},
        {"op": "placement", "settings": {"placement": "random"}}]})";
    runJson("groom hair.hairloom --script former.json -o former.hairloom");
    runJson("groom hair.hairloom --script now.json -o now.hairloom");
    EXPECT_EQ(readText(folder / "former.hairloom"), readText(folder / "now.hairloom"));
}

TEST_F(CliSettings, PoissonDiskPlacementHasTwoNames) {
    std::string arguments = createArguments();
    runJson(arguments);
    const std::string darts = readText(folder / "hair.hairloom");
    const std::string former = "--placement dart";
    arguments.replace(arguments.find(former), former.size(), "--placement poissonDisk");
    runJson(arguments);
    EXPECT_EQ(readText(folder / "hair.hairloom"), darts);
    EXPECT_NE(darts.find("\"placement\": \"poissonDisk\""), std::string::npos);
}

TEST_F(CliSettings, TheStiffnessFollowsACurveOfKeys) {
    runJson(createArguments());
    const auto hashWith = [&](const std::string& settings) {
        runJson("set hair.hairloom simulation.angularStiffness=0.6 " + settings + " -o curved.hairloom");
        return runJson("simulate curved.hairloom --frames 5 --motion nod")["state_hash"].get<std::string>();
    };
    const std::string straight = hashWith("simulation.angularCurve=[[0,1],[1,0.25]]");
    EXPECT_EQ(hashWith("simulation.angularTipShare=0.25"), straight) << "as it was called before";
    EXPECT_NE(hashWith("simulation.angularCurve=[[0,1],[0.5,0.05],[1,0.25]]"), straight);
    const Outcome order =
        run("set hair.hairloom simulation.angularCurve=[[0,1],[0.5,1],[0.4,1],[1,1]] -o x.hairloom");
    EXPECT_EQ(order.exitCode, 2);
    EXPECT_THAT(order.errors, HasSubstr("angularCurve has key 2 at 0.4"));
    const nlohmann::json listed = runJson("set --list");
    bool isListed = false;
    for (const auto& field : listed["fields"]) {
        isListed |= field["field"] == "simulation.angularCurve" &&
                    field["default"] == nlohmann::json::parse("[[0,1],[1,0.5]]");
    }
    EXPECT_TRUE(isListed);
}

TEST_F(CliSettings, PresetsSetWhatAFibreIsMadeOf) {
    runJson(createArguments());
    std::map<std::string, std::string> hashes;
    const auto listed = runJson("set --list");
    for (const auto& preset : listed["presets"]) {
        const auto name = preset["preset"].get<std::string>();
        EXPECT_EQ(runJson("set hair.hairloom --preset " + name + " -o " + name + ".hairloom")["changed"], 9);
        EXPECT_GE(preset["eccentricity"], 0.6) << name;
        const std::string eccentricity = "\"eccentricity\": " + preset["eccentricity"].dump();
        EXPECT_NE(readText(folder / (name + ".hairloom")).find(eccentricity), std::string::npos) << name;
        hashes[runJson("simulate " + name + ".hairloom --frames 5 --motion nod")["state_hash"]] = name;
    }
    EXPECT_EQ(hashes.size(), 3u) << "fibres of other stiffness should move otherwise";
    // Fields come after the preset.
    runJson(
        "set hair.hairloom --preset caucasian simulation.angularStiffness=0.5 simulation.sectionRatio=1 -o "
        "a.hairloom");
    runJson(
        "set hair.hairloom --preset mongolian simulation.angularStiffness=0.5 simulation.sectionRatio=1 -o "
        "b.hairloom");
    EXPECT_EQ(runJson("simulate a.hairloom --frames 5 --motion nod")["state_hash"],
              runJson("simulate b.hairloom --frames 5 --motion nod")["state_hash"]);
    EXPECT_EQ(run("set hair.hairloom --preset angora -o hair.hairloom").exitCode, 2);
}

}  // namespace
}  // namespace hairloom::test
