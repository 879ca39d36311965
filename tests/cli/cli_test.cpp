// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as docs/cli.md promises it, on the sample head.

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
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
         "error: --method is 'strand'; expected one of strands, projective, lattice (did you mean "
         "strands?)\n"},
        {"simulate x --frames 0", "error: --frames is '0'; expected 1 to 1000000\n"},
        {"simulate x --frames", "error: --frames has no value; expected 1 to 1000000\n"},
        {"simulate x --frames ten", "error: --frames is 'ten'; expected 1 to 1000000\n"},
        {"simulate --motoin nod", "error: there is no option --motoin; did you mean --motion?\n"},
        {"simulate", "error: groom is required; see hairloom-cli simulate --help\n"},
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
    }
    EXPECT_GE(jobs, 16u);
}

TEST_F(Cli, SimulateWarnsOfStepsThatAreTooLong) {
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

TEST_F(Cli, SetAndInfoWarnOfSpringsThatTremble) {
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

TEST_F(Cli, StabilityWritesItsCasesAndMaps) {
    const auto report =
        runJson("stability -o out --integrators rk4 --cells 4 --steps 200 --steps-at-rest 8000");
    EXPECT_EQ(report["cases"].size(), 30u);
    EXPECT_EQ(report["cases"][8]["integrator"], "rk4");
    EXPECT_TRUE(report["cases"][8]["threshold"].is_number());
    EXPECT_EQ(report["maps"].size(), 2u);
    for (const char* file : {"report.html", "cases.csv", "cases.json", "cases.md", "stability-rk4-coils.svg"})
        EXPECT_TRUE(fs::exists(folder / "out" / file)) << file;
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

TEST_F(Cli, SimulationDoesNotDependOnThreadsAndKeepsLengths) {
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

TEST_F(Cli, ClipOfTheSampleHeadMovesTheHair) {
    runJson(createArguments());
    const auto moved = runJson("simulate hair.hairloom --frames 20 --fps 30 --motion clip:nod_and_turn");
    const auto still = runJson("simulate hair.hairloom --frames 20 --fps 30");
    EXPECT_NE(moved["state_hash"], still["state_hash"]);
    const Outcome unknown = run("simulate hair.hairloom --motion clip:dance");
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.errors, HasSubstr("nod_and_turn")) << "the clips there are";
}

TEST_F(Cli, HairThatFallsThroughTheHeadIsSeen) {
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

TEST_F(Cli, FittedSpheresGoWithTheHead) {
    runJson(createArguments());
    const auto fitted = runJson("spheres hair.hairloom --fit 6 -o on.hairloom");
    EXPECT_EQ(fitted["on_bones"], 6);
    const Outcome lost = run("spheres hair.hairloom --fit 6 --character none.glb -o off.hairloom");
    EXPECT_EQ(lost.exitCode, 1);
    EXPECT_THAT(lost.errors, HasSubstr("none.glb"));
    EXPECT_FALSE(fs::exists(folder / "off.hairloom"));
}

TEST_F(Cli, OtherMethodsReportAndRecordAlike) {
    runJson(createArguments());
    const std::string scene = "simulate hair.hairloom --frames 10 --fps 30 --motion nod ";
    const auto engine = runJson(scene + "--record strands.frames");
    EXPECT_EQ(engine["method"], "strands");
    EXPECT_EQ(runJson(scene + "--against strands.frames")["error_mm"], 0.0) << "the same run again";
    for (const std::string method : {"projective", "lattice"}) {
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
    const Outcome volume = run(scene + "--method lattice --hair-hair");
    EXPECT_EQ(volume.exitCode, 1);
    EXPECT_THAT(volume.errors, HasSubstr("velocities"));
}

TEST_F(Cli, AccuracyMeasuresAGridAndWritesAReport) {
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

TEST_F(Cli, EffectsReportReasonAndCost) {
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

TEST_F(Cli, AStrokeOfDyeIsReplayed) {
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

TEST_F(Cli, AStackIsShownSetChangedAndBaked) {
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

TEST_F(Cli, AStackThatCannotBeIsRefusedWithItsPlace) {
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

TEST_F(Cli, SettingsAreCheckedByNameAndRange) {
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

TEST_F(Cli, SettingsAreKnownByTheirFormerNames) {
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

TEST_F(Cli, PoissonDiskPlacementHasTwoNames) {
    std::string arguments = createArguments();
    runJson(arguments);
    const std::string darts = readText(folder / "hair.hairloom");
    const std::string former = "--placement dart";
    arguments.replace(arguments.find(former), former.size(), "--placement poissonDisk");
    runJson(arguments);
    EXPECT_EQ(readText(folder / "hair.hairloom"), darts);
    EXPECT_NE(darts.find("\"placement\": \"poissonDisk\""), std::string::npos);
}

TEST_F(Cli, TheStiffnessFollowsACurveOfKeys) {
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

TEST_F(Cli, PresetsSetWhatAFibreIsMadeOf) {
    runJson(createArguments());
    std::map<std::string, std::string> hashes;
    const auto listed = runJson("set --list");
    for (const auto& preset : listed["presets"]) {
        const auto name = preset["preset"].get<std::string>();
        EXPECT_EQ(runJson("set hair.hairloom --preset " + name + " -o " + name + ".hairloom")["changed"], 8);
        EXPECT_GE(preset["eccentricity"], 0.6) << name;
        const std::string eccentricity = "\"eccentricity\": " + preset["eccentricity"].dump();
        EXPECT_NE(readText(folder / (name + ".hairloom")).find(eccentricity), std::string::npos) << name;
        hashes[runJson("simulate " + name + ".hairloom --frames 5 --motion nod")["state_hash"]] = name;
    }
    EXPECT_EQ(hashes.size(), 3u) << "fibres of other stiffness should move otherwise";
    // Fields come after the preset.
    runJson("set hair.hairloom --preset caucasian simulation.angularStiffness=0.5 -o a.hairloom");
    runJson("set hair.hairloom --preset mongolian simulation.angularStiffness=0.5 -o b.hairloom");
    EXPECT_EQ(runJson("simulate a.hairloom --frames 5 --motion nod")["state_hash"],
              runJson("simulate b.hairloom --frames 5 --motion nod")["state_hash"]);
    EXPECT_EQ(run("set hair.hairloom --preset angora -o hair.hairloom").exitCode, 2);
}

TEST_F(Cli, BenchComparesTheEngineWithTheThesis) {
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
    // Eight rows and four columns of Table 3; the sum is added up by hand from its print.
    EXPECT_EQ(ofTable3, 32);
    EXPECT_NEAR(printed, 33.2929, 1e-6);
    const std::string tables = readText(folder / "tables.md");
    EXPECT_THAT(tables, HasSubstr("## Table 3 of the thesis"));
    EXPECT_THAT(tables, HasSubstr("| integration | rod |"));
    EXPECT_THAT(tables, HasSubstr("--repeat 2"));
    EXPECT_EQ(run("bench io --quick").exitCode, 2) << "of sim alone";
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
    EXPECT_THAT(unknown.errors, HasSubstr("no group 'helper-c'; one of: head, helper-a, helper-b"));
    EXPECT_FALSE(fs::exists(folder / "none.png"));
}

TEST_F(Cli, RecordedFramesCanBePictured) {
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
