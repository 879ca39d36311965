// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs that move hair or measure how it moves, on the sample head.

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <set>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class CliMotion : public CommandLineTest {};

TEST_F(CliMotion, SimulateWarnsOfStepsThatAreTooLong) {
    runJson(createArguments());
    const auto sound = runJson("simulate hair.hairloom --frames 2");
    EXPECT_TRUE(sound["advice"].is_null());
    const auto report = runJson("simulate hair.hairloom --frames 2 --integrator leapfrog --substeps 1");
    EXPECT_THAT(report["advice"]["words"].get<std::string>(), HasSubstr("leapfrog is unstable"));
    EXPECT_GT(report["advice"]["factor"].get<double>(), 1.0);
    EXPECT_THAT(report["advice"]["offers"][0].get<std::string>(), HasSubstr("substeps instead of 1"));
    EXPECT_THAT(run("simulate hair.hairloom --frames 2 --integrator leapfrog --substeps 1").errors,
                HasSubstr("warning: leapfrog is unstable"));
}

TEST_F(CliMotion, SetAndInfoWarnOfSpringsThatTremble) {
    runJson(createArguments("", 7, 40));
    EXPECT_TRUE(runJson("info hair.hairloom")["advice"].is_null());
    std::ofstream(folder / "curl.json")
        << R"({"hairloom_script": 1, "operations": [{"op": "curl", "radius": 0.01, "frequency": 40}]})";
    runJson("groom hair.hairloom --script curl.json -o curls.hairloom");
    EXPECT_TRUE(runJson("info curls.hairloom")["advice"].is_null()) << "rods come to rest";
    const std::string set =
        "set curls.hairloom simulation.strandModel=springs simulation.integrator=implicitEuler "
        "simulation.substeps=8 -o springs.hairloom --force";
    const auto advice = runJson(set)["advice"];
    EXPECT_THAT(advice["words"].get<std::string>(), HasSubstr("tremble at rest"));
    EXPECT_GT(advice["trembling_strands"].get<int>(), 0);
    EXPECT_THAT(advice["offers"][0].get<std::string>(), HasSubstr("elastic rods"));
    EXPECT_THAT(run(set).errors, HasSubstr("warning: springs with implicitEuler tremble"));
    EXPECT_EQ(runJson("info springs.hairloom")["advice"], advice);
}

TEST_F(CliMotion, StabilityWritesItsCasesAndMaps) {
    const auto report =
        runJson("stability -o out --integrators rk4 --cells 4 --steps 200 --steps-at-rest 8000");
    EXPECT_EQ(report["cases"].size(), 30u);
    EXPECT_EQ(report["cases"][8]["integrator"], "rk4");
    EXPECT_TRUE(report["cases"][8]["threshold"].is_number());
    EXPECT_EQ(report["maps"].size(), 2u);
    for (const char* file : {"report.html", "cases.csv", "cases.json", "cases.md", "stability-rk4-coils.svg"})
        EXPECT_TRUE(fs::exists(folder / "out" / file)) << file;
}

TEST_F(CliMotion, SimulationDoesNotDependOnThreadsAndKeepsLengths) {
    runJson(createArguments());
    const std::string arguments = "simulate hair.hairloom --frames 30 --fps 60 --wind 3,0,1 --motion nod ";
    const auto one = runJson(arguments + "--threads 1");
    const auto four = runJson(arguments + "--threads 4");
    EXPECT_EQ(one["state_hash"], four["state_hash"]);
    EXPECT_EQ(one["nan_count"], 0);
    EXPECT_LT(one["max_stretch"], 0.02);
    EXPECT_NE(one["state_hash"], runJson("simulate hair.hairloom --frames 30 --fps 60")["state_hash"]);
    bool windIsOn = false;
    for (const auto& effect : one["effects"]) {
        EXPECT_FALSE(effect["why"].get<std::string>().empty()) << effect.dump();
        windIsOn |= effect["name"] == "wind" && effect["on"].get<bool>();
    }
    EXPECT_TRUE(windIsOn);
}

TEST_F(CliMotion, ClipOfTheSampleHeadMovesTheHair) {
    runJson(createArguments());
    const auto moved = runJson("simulate hair.hairloom --frames 20 --fps 30 --motion clip:nod_and_turn");
    const auto still = runJson("simulate hair.hairloom --frames 20 --fps 30");
    EXPECT_NE(moved["state_hash"], still["state_hash"]);
    const Outcome unknown = run("simulate hair.hairloom --motion clip:dance");
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.errors, HasSubstr("nod_and_turn")) << "the clips there are";
}

TEST_F(CliMotion, HairThatFallsThroughTheHeadIsSeen) {
    runJson(createArguments());
    const auto standing = runJson("simulate hair.hairloom --frames 1");
    EXPECT_LT(standing["max_mesh_penetration_mm"], 1);
    EXPECT_LT(standing["share_inside_mesh"], 0.01);
    EXPECT_TRUE(standing["authored_depth_mm"].is_number());
    runJson("set hair.hairloom simulation.angularStiffness=0.01 simulation.restGravity=0 -o soft.hairloom");
    const auto fallen = runJson("simulate soft.hairloom --frames 60");  // among no spheres
    EXPECT_GT(fallen["max_mesh_penetration_mm"], 5);
    EXPECT_GT(fallen["share_inside_mesh"], 0.05);
    EXPECT_LT(fallen["share_inside_mesh"], 1);
    EXPECT_EQ(fallen["max_mesh_penetration_mm"], fallen["max_guide_penetration_mm"]) << "no follow hairs";
    EXPECT_GT(fallen["deepest_frame"], 5);
    runJson("set soft.hairloom interpolation.followPerGuide=6 -o many.hairloom");
    const auto many = runJson("simulate many.hairloom --frames 60");
    EXPECT_EQ(many["max_guide_penetration_mm"], fallen["max_guide_penetration_mm"]);
    EXPECT_GT(many["max_mesh_penetration_mm"], 5);
    // Hair that swings out of the head again was in it all the same.
    EXPECT_GE(runJson("simulate soft.hairloom --frames 90")["max_mesh_penetration_mm"],
              fallen["max_mesh_penetration_mm"]);
}

TEST_F(CliMotion, FittedSpheresGoWithTheHead) {
    runJson(createArguments());
    const auto fitted = runJson("spheres hair.hairloom --fit 6 -o on.hairloom");
    EXPECT_EQ(fitted["on_bones"], 6);
    const Outcome lost = run("spheres hair.hairloom --fit 6 --character none.glb -o off.hairloom");
    EXPECT_EQ(lost.exitCode, 1);
    EXPECT_THAT(lost.errors, HasSubstr("none.glb"));
    EXPECT_FALSE(fs::exists(folder / "off.hairloom"));
}

TEST_F(CliMotion, OtherMethodsReportAndRecordAlike) {
    runJson(createArguments());
    const std::string scene = "simulate hair.hairloom --frames 10 --fps 30 --motion nod ";
    const auto engine = runJson(scene + "--record strands.frames");
    EXPECT_EQ(engine["method"], "strands");
    EXPECT_EQ(runJson(scene + "--against strands.frames")["error_mm"], 0.0) << "the same run again";
    for (const std::string method : {"projective", "chain", "lattice", "particles", "hybrid"}) {
        const auto other =
            runJson(scene + "--method " + method + " --against strands.frames --record o.frames");
        EXPECT_EQ(other["method"], method);
        EXPECT_EQ(other["nan_count"], 0);
        EXPECT_GT(other["error_mm"], 0.1);
        EXPECT_GE(other["error_mm_max"], other["error_mm"]);
        for (const auto& [key, value] : engine.items()) EXPECT_TRUE(other.contains(key)) << key;
        EXPECT_EQ(fs::file_size(folder / "o.frames"), fs::file_size(folder / "strands.frames"));
    }
    EXPECT_EQ(run(scene + "--method guess").exitCode, 2);
    const Outcome longer = run("simulate hair.hairloom --frames 11 --fps 30 --against strands.frames");
    EXPECT_EQ(longer.exitCode, 1);
    EXPECT_THAT(longer.errors, HasSubstr("strands.frames"));
    runJson("set hair.hairloom simulation.hairHair=true -o hairs.hairloom");
    const auto asFlag = runJson(scene + "--hair-hair"),
               asSetting = runJson("simulate hairs.hairloom --frames 10 --fps 30 --motion nod");
    EXPECT_EQ(asFlag["state_hash"], asSetting["state_hash"]);
    EXPECT_NE(asFlag["state_hash"], engine["state_hash"]);
}

TEST_F(CliMotion, ProjectiveHairTurnsToAStyleAndKeepsApart) {
    runJson(createArguments());
    std::ofstream(folder / "bend.json")
        << R"({"hairloom_script": 1, "operations": [{"op": "bend", "sidewaysDegrees": 60}]})";
    runJson("groom hair.hairloom --script bend.json -o bent.hairloom");
    const std::string still = "simulate hair.hairloom --frames 60 --fps 30 --method projective ";
    const std::string asBent =
        "simulate bent.hairloom --frames 60 --fps 30 --method projective --record bent.frames";
    runJson(asBent);
    const auto authored = runJson(still + "--against bent.frames"),
               turned = runJson(still + "--against bent.frames --style bent.hairloom");
    EXPECT_NE(authored["state_hash"], turned["state_hash"]);
    EXPECT_GT(authored["error_mm"], 2.0);
    EXPECT_LT(turned["error_mm"], 0.5 * authored["error_mm"].get<double>());
    EXPECT_LT(turned["max_stretch"], 1e-4);
    EXPECT_EQ(runJson(still)["state_hash"], authored["state_hash"]);
    EXPECT_NE(runJson(still + "--motion nod --hair-hair")["state_hash"],
              runJson(still + "--motion nod")["state_hash"]);
    const Outcome engine = run("simulate hair.hairloom --style bent.hairloom");
    EXPECT_EQ(engine.exitCode, 1);
    EXPECT_THAT(engine.errors, HasSubstr("expected the method 'projective'"));
    std::ofstream(folder / "long.json")
        << R"({"hairloom_script": 1, "operations": [{"op": "set_length", "length": 0.3}]})";
    runJson("groom hair.hairloom --script long.json -o long.hairloom");
    const Outcome longer = run(still + "--style long.hairloom");
    EXPECT_EQ(longer.exitCode, 1);
    EXPECT_THAT(longer.errors, HasSubstr("long.hairloom: segment 1 of strand 0"));
}

TEST_F(CliMotion, AccuracyMeasuresAGridAndWritesAReport) {
    runJson(createArguments());
    const auto report = runJson(
        "accuracy hair.hairloom -o out --motion nod --frames 4 --strands 10 --substeps 1,4 --iterations 1"
        " --points 6,12 --repeat 1 --truth-substeps 8 --truth-strands 3");
    EXPECT_EQ(report["runs"], 4);
    EXPECT_EQ(report["strands"], 10);
    EXPECT_EQ(report["truth"], "reference");
    EXPECT_EQ(report["strands_compared"], 3);
    ASSERT_FALSE(report["front"].empty());
    for (const auto& point : report["front"]) {
        EXPECT_GT(point["ms"], 0.0);
        EXPECT_GT(point["error_mm"], 0.0);
        EXPECT_LE(point["error_mm"], point["error_mm_max"]);
        EXPECT_TRUE(point["setting"]["substeps"] == 1 || point["setting"]["substeps"] == 4);
    }
    for (const std::string file : report["files"]) EXPECT_TRUE(fs::exists(folder / "out" / file)) << file;
    EXPECT_THAT(readText(folder / "out" / "report.html"), HasSubstr("--motion nod --frames 4"));
    EXPECT_THAT(readText(folder / "out" / "data.csv"),
                StartsWith("integrator,substeps,lengthIterations,points,ms_median,"));

    // 2 m away, 1000 pixels for 2 · 2 m · tan 15°: 1 mm is 0.933 pixels.
    std::ofstream(folder / "view.json") << R"({"size": [1500, 1000], "camera": {"eye": [0, 1.7, 2.0],
        "target": [0, 1.7, 0], "up": [0, 1, 0], "fov_y_deg": 30}})";
    const auto seen = runJson(
        "accuracy hair.hairloom -o seen --frames 4 --strands 10 --substeps 1 --points 6 --repeat 1 --view "
        "view.json"
        " --truth engine --truth-substeps 8");
    for (const auto& point : seen["front"])
        EXPECT_NEAR(point["error_px"].get<double>() / point["error_mm"].get<double>(), 0.933, 0.06);
    std::ofstream(folder / "blind.json") << R"({"size": [1500, 1000]})";
    const Outcome blind = run("accuracy hair.hairloom -o bad --view blind.json");
    EXPECT_EQ(blind.exitCode, 1);
    EXPECT_THAT(blind.errors, HasSubstr("blind.json: the view has no camera"));

    const auto engine = runJson(
        "accuracy hair.hairloom -o engine --frames 4 --strands 10 --substeps 4 --iterations 1 --points 6"
        " --repeat 1 --truth engine --truth-substeps 8");
    EXPECT_EQ(engine["truth"], "engine-converged");
    EXPECT_EQ(engine["strands_compared"], 10);

    const Outcome unknown = run("accuracy hair.hairloom -o bad --integrators guess");
    EXPECT_EQ(unknown.exitCode, 2);
    EXPECT_THAT(unknown.errors, HasSubstr("verlet")) << "the integrators there are";
    EXPECT_FALSE(fs::exists(folder / "bad"));
}

TEST_F(CliMotion, EffectsReportReasonAndCost) {
    runJson(createArguments());
    const auto report = runJson("effects hair.hairloom --frames 4 --repeat 1 --motion nod");
    std::map<std::string, nlohmann::json> effects;
    for (const auto& effect : report["effects"]) effects[effect["name"]] = effect;
    EXPECT_TRUE(effects.at("length")["on"].get<bool>());
    EXPECT_GT(effects.at("angular")["ms_off"], 0.0);
    EXPECT_EQ(effects.at("angular")["turned_off_by"], "simulation.angularStiffness=0");
    EXPECT_FALSE(effects.at("wind")["on"].get<bool>());
    EXPECT_EQ(effects.at("wind")["why"], "off, zero speed");
    EXPECT_TRUE(effects.at("wind")["ms_on"].is_null());
    EXPECT_EQ(effects.at("collision")["why"], "off, no spheres");
    const auto windy = runJson("effects hair.hairloom --frames 4 --repeat 1 --wind 3,0,0");
    for (const auto& effect : windy["effects"]) {
        if (effect["name"] != "wind") continue;
        EXPECT_THAT(effect["note"].get<std::string>(), HasSubstr("drag is on"));
    }
}

TEST_F(CliMotion, BenchComparesTheEngineWithTheThesis) {
    const auto report = runJson("bench sim --quick --strands 40 --repeat 2 --markdown tables.md");
    std::set<std::string> names;
    double printed = 0.0;
    int ofTable3 = 0;
    for (const auto& row : report["rows"]) {
        EXPECT_TRUE(names.insert(row["name"].get<std::string>()).second) << row["name"];
        EXPECT_LE(row["min"], row["median"]);
        EXPECT_LE(row["median"], row["max"]);
        EXPECT_FALSE(row["unit"].get<std::string>().empty());
        if (!row.contains("thesis")) continue;
        ++ofTable3;
        printed += row["thesis"].get<double>();
        EXPECT_GT(row["median"].get<double>(), 0.0) << row["name"];
    }
    const char* const first[] = {"step, short sample, 1 thread", "step, shoulder sample, 1 thread",
                                 "step, long sample, 1 thread"};
    for (std::size_t i = 0; i < std::size(first); ++i) EXPECT_EQ(report["rows"][i]["name"], first[i]);
    std::size_t next = 0;
    while (report["rows"][next]["name"].get<std::string>().find(" sample, ") != std::string::npos) ++next;
    EXPECT_EQ(report["rows"][next]["name"], "step, 40x16, straight hair, wind and ten spheres, 1 thread");
    // Eight rows and four columns of Table 3; the sum is added up by hand from its print.
    EXPECT_EQ(ofTable3, 32);
    EXPECT_NEAR(printed, 33.2929, 1e-6);
    const std::string tables = readText(folder / "tables.md");
    EXPECT_THAT(tables, HasSubstr("## Table 3 of the thesis"));
    EXPECT_THAT(tables, HasSubstr("| integration | rod |"));
    EXPECT_THAT(tables, HasSubstr("--repeat 2"));
    EXPECT_EQ(run("bench io --quick").exitCode, 2) << "of sim alone";
}

TEST_F(CliMotion, RecordedFramesCanBePictured) {
    runJson(createArguments());
    runJson("simulate hair.hairloom --frames 10 --fps 30 --motion spin --record hair.frames");
    runJson("render hair.hairloom --record hair.frames --frame 9 -o moved.png --size 120x120");
    runJson("render hair.hairloom -o rest.png --size 120x120");
    EXPECT_NE(readText(folder / "moved.png"), readText(folder / "rest.png"));
    const Outcome late =
        run("render hair.hairloom --record hair.frames --frame 10 -o late.png --size 120x120");
    EXPECT_EQ(late.exitCode, 1);
    EXPECT_THAT(late.errors, HasSubstr("10 frames"));
    EXPECT_FALSE(fs::exists(folder / "late.png"));
}

}  // namespace
}  // namespace hairloom::test
