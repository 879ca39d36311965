// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that collides with the skin of its head, from the fit to what leaves.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Colliders : public CommandLineTest {
  protected:
    /// Hair that falls into the head, as soft.hairloom, and with its skin as a collider, as on.hairloom.
    nlohmann::json fitSkin() {
        runJson(createArguments());
        runJson(
            "set hair.hairloom simulation.angularStiffness=0.01 simulation.restGravity=0 "
            "interpolation.followPerGuide=2 -o soft.hairloom");
        return runJson("colliders soft.hairloom --fit field -o on.hairloom");
    }
};

TEST_F(Colliders, TheSkinKeepsHairOutOfTheHead) {
    const auto fitted = fitSkin();
    EXPECT_EQ(fitted["fit"], "field");
    EXPECT_EQ(fitted["body"], true);
    EXPECT_LE(fitted["worst_gap_mm"], 1) << fitted["notes"];
    EXPECT_LE(fitted["bytes"], 1'000'000);
    const Outcome small = run("colliders soft.hairloom --fit field --kilobytes 100 -o small.hairloom --json");
    EXPECT_THAT(small.errors, HasSubstr("to fit into 100 kB"));
    EXPECT_LE(small.json()["bytes"], 100'000);
    EXPECT_EQ(run("colliders soft.hairloom --fit field --kilobytes 1 -o x.hairloom").exitCode, 2);
    EXPECT_THAT(fitted["bones"], testing::Contains("head"));
    const std::string motion = " --frames 30 --motion clip:nod_and_turn";
    const auto bare = runJson("simulate soft.hairloom" + motion);
    const auto kept = runJson("simulate on.hairloom" + motion);
    EXPECT_GT(bare["max_mesh_penetration_mm"], 5);
    EXPECT_LT(kept["max_mesh_penetration_mm"], 0.3 * bare["max_mesh_penetration_mm"].get<double>());
    EXPECT_FALSE(kept.contains("notes"));
    // Off again, and it is as if it had never been.
    EXPECT_EQ(runJson("colliders on.hairloom --fit none -o off.hairloom")["body"], false);
    EXPECT_EQ(readText(folder / "off.hairloom"), readText(folder / "soft.hairloom"));
}

TEST_F(Colliders, AreListedAndMeasuredAsTheyWereFitted) {
    const auto fitted = fitSkin();
    const auto listed = runJson("colliders on.hairloom");
    for (const char* key : {"worst_gap_mm", "mean_gap_mm", "worst_bulge_mm"})
        EXPECT_EQ(listed[key], fitted[key]) << key;
    std::vector<nlohmann::json> bones;
    for (const auto& row : listed["colliders"]) {
        EXPECT_EQ(row["kind"], "field");
        bones.push_back(row["bone"]);
    }
    EXPECT_THAT(fitted["bones"], testing::ElementsAreArray(bones));

    const auto spheres =
        runJson("colliders soft.hairloom --fit spheres --count 9 --near 0.03 -o nine.hairloom");
    ASSERT_EQ(spheres["spheres"], 9);
    const auto nine = runJson("colliders nine.hairloom --near 0.03");
    EXPECT_EQ(nine["colliders"], spheres["colliders"]);
    EXPECT_EQ(nine["worst_gap_mm"], spheres["worst_gap_mm"]);
    EXPECT_EQ(nine["colliders"][8]["kind"], "sphere");
    EXPECT_FALSE(nine["colliders"][8]["bone"].is_null());
    EXPECT_GT(nine["colliders"][8]["radius"], 0);

    // Those that only represent the skin are left to it, where it is fitted.
    const auto both = runJson("colliders nine.hairloom --fit field -o both.hairloom");
    std::size_t left = 0;
    for (const auto& row : both["colliders"]) left += row.value("of_skin", false) ? 1 : 0;
    EXPECT_GE(left, 5u);
    for (const auto& row : nine["colliders"]) EXPECT_EQ(row["of_skin"], false);

    // Without a file to write, a fit is measured alone.
    const std::string before = readText(folder / "nine.hairloom");
    EXPECT_LT(runJson("colliders nine.hairloom --fit field --kilobytes 300")["worst_gap_mm"],
              nine["worst_gap_mm"]);
    EXPECT_EQ(readText(folder / "nine.hairloom"), before);
    const auto bare = runJson("colliders soft.hairloom");
    EXPECT_TRUE(bare["colliders"].empty());
    EXPECT_TRUE(bare["worst_gap_mm"].is_null());
}

TEST_F(Colliders, FewSpheresComeAsCloseAsWasAskedFor) {
    runJson(createArguments());
    const auto fitted = runJson("colliders hair.hairloom --fit spheres --error 30 -o on.hairloom");
    EXPECT_LE(fitted["worst_gap_mm"], 30);
    EXPECT_GE(fitted["spheres"], 4);
    EXPECT_EQ(fitted["body"], false);
    const Outcome fine = run("colliders hair.hairloom --fit spheres --error 0.1 -o fine.hairloom --json");
    EXPECT_THAT(fine.errors, HasSubstr("--fit field"));
    EXPECT_EQ(fine.json()["notes"].size(), 1u);
    EXPECT_EQ(run("colliders hair.hairloom -o x.hairloom").exitCode, 2);
    EXPECT_EQ(run("colliders hair.hairloom --fit boxes -o x.hairloom").exitCode, 2);
    EXPECT_EQ(run("colliders hair.hairloom --fit field --count 9 -o x.hairloom").exitCode, 2);
    const Outcome lost = run("colliders hair.hairloom --fit field --character none.glb -o x.hairloom");
    EXPECT_EQ(lost.exitCode, 1);
    EXPECT_THAT(lost.errors, HasSubstr("none.glb"));
    EXPECT_FALSE(fs::exists(folder / "x.hairloom"));
}

TEST_F(Colliders, CapsulesCoverMoreThanAsManySpheres) {
    runJson(createArguments());
    const std::string how = " --count 10 --near 0.05 -o ";
    const auto spheres = runJson("colliders hair.hairloom --fit spheres" + how + "spheres.hairloom");
    const auto capsules = runJson("colliders hair.hairloom --fit capsules" + how + "capsules.hairloom");
    EXPECT_EQ(spheres["capsules"], 0);
    EXPECT_EQ(capsules["spheres"], 10);
    ASSERT_GE(capsules["capsules"], 3);
    EXPECT_LE(capsules["worst_gap_mm"], spheres["worst_gap_mm"]);
    EXPECT_LT(capsules["mean_gap_mm"], spheres["mean_gap_mm"]);
    const auto listed = runJson("colliders capsules.hairloom --near 0.05");
    EXPECT_EQ(listed["colliders"], capsules["colliders"]);
    EXPECT_EQ(listed["worst_gap_mm"], capsules["worst_gap_mm"]);
    std::size_t found = 0;
    for (const auto& row : listed["colliders"]) {
        if (row["kind"] != "capsule") continue;
        ++found;
        EXPECT_EQ(row["bone"], row["end"]["bone"]);
        EXPECT_GT(row["end"]["radius"], 0);
    }
    EXPECT_EQ(found, listed["capsules"]);
    // They hold hair on any engine that meets spheres.
    const auto deepest = [&](const std::string& project, const std::string& model) {
        runJson("set " + project +
                " simulation.angularStiffness=0.01 simulation.restGravity=0 -o soft.hairloom --force");
        return runJson("simulate soft.hairloom --frames 90 --model " + model)["max_mesh_penetration_mm"]
            .get<double>();
    };
    for (const char* model : {"rods", "springs"}) {
        const double bare = deepest("hair.hairloom", model);
        // Hair hangs into skin that none of them covers, too.
        const double kept = deepest("capsules.hairloom", model);
        EXPECT_LT(kept, bare - 10) << model;
        EXPECT_LE(kept, deepest("spheres.hairloom", model) + 1) << model;
    }
    // One that has no second sphere is no project.
    EXPECT_EQ(run("validate capsules.hairloom").exitCode, 0);
    std::ofstream(folder / "wrong.json")
        << R"([{"name": "a", "centre": [0, 1, 0], "radius": 0.1, "bone": "", "joined": 5}])";
    EXPECT_EQ(run("spheres hair.hairloom --from wrong.json -o x.hairloom").exitCode, 1);
    EXPECT_FALSE(fs::exists(folder / "x.hairloom"));
}

TEST_F(Colliders, WhatPassesThroughTheSkinOrLosesItIsTold) {
    fitSkin();
    const auto noted = [&](const std::string& arguments, const char* words) {
        const Outcome outcome = run(arguments + " --json");
        EXPECT_EQ(outcome.exitCode, 0) << outcome.errors;
        EXPECT_THAT(outcome.errors, HasSubstr(words)) << arguments;
        const auto report = outcome.json();
        EXPECT_TRUE(report.contains("notes") && report["notes"].size() == 1 &&
                    report["notes"][0].get<std::string>().find(words) != std::string::npos)
            << report.dump();
    };
    noted("simulate on.hairloom --frames 2 -o moved.hairloom", "moved.hairloom: has no skin collider");
    noted("simulate on.hairloom --frames 2 --model springs", "pass through the skin collider");
    noted("simulate on.hairloom --frames 2 --method lattice", "pass through the skin collider");
    const auto taken = runJson("simulate on.hairloom --frames 2 -o taken.hairloom --take");
    EXPECT_FALSE(taken.contains("notes")) << "is of the head at rest";
    // Games have it, and are told how much it takes.
    const auto asset = runJson("export on.hairloom --format runtime -o hair.hairrt");
    EXPECT_THAT(asset["findings"].dump(), HasSubstr("the skin collider takes"));
    EXPECT_EQ(asset["findings"].dump().find("left out: hair meets"), std::string::npos);
    EXPECT_EQ(runJson("export soft.hairloom --format runtime -o bare.hairrt")["findings"].dump().find(
                  "skin collider"),
              std::string::npos);
}

TEST_F(Colliders, TransferTellsThatTheSkinWasOfTheOldHead) {
    fitSkin();
    const std::string to = "transfer on.hairloom --to '" + bustFile() + "' -o b.hairloom";
    const Outcome moved = run(to + " --json");
    EXPECT_EQ(moved.exitCode, 0) << moved.errors;
    EXPECT_THAT(moved.errors, HasSubstr("skin collider"));
    EXPECT_THAT(moved.json()["head"]["warnings"].dump(), HasSubstr("skin collider"));
    EXPECT_EQ(runJson("colliders b.hairloom --fit none -o c.hairloom")["body"], false);
}

TEST_F(Colliders, RecordsKeepWhereTheSkinIs) {
    fitSkin();
    runJson("set on.hairloom interpolation.followPerGuide=4 -o many.hairloom");
    runJson("set soft.hairloom interpolation.followPerGuide=4 -o bare.hairloom");
    const std::string motion = " --frames 20 --motion clip:nod_and_turn --record ";
    runJson("simulate many.hairloom" + motion + "on.frames");
    runJson("simulate bare.hairloom" + motion + "off.frames");
    const std::string how = " --engine software --frame 19 --size 96x96 -o ";
    EXPECT_FALSE(runJson("render many.hairloom --record on.frames" + how + "on.png").contains("notes"));
    // The same strands, whose follow hairs nothing leads out.
    const Outcome old = run("render bare.hairloom --record on.frames" + how + "bare.png --json");
    EXPECT_EQ(old.exitCode, 0) << old.errors;
    EXPECT_NE(readText(folder / "on.png"), readText(folder / "bare.png"));
    // A record from before the skin was fitted does not say where it is.
    const Outcome before = run("render many.hairloom --record off.frames" + how + "before.png --json");
    EXPECT_EQ(before.exitCode, 0) << before.errors;
    EXPECT_THAT(before.errors, HasSubstr("Record the groom again"));
    EXPECT_EQ(before.json()["notes"].size(), 1u);
    // Damage in what is new of the header.
    std::string bytes = readText(folder / "on.frames");
    bytes[50] = 1;
    std::ofstream(folder / "bad.frames", std::ios::binary) << bytes;
    const Outcome bad = run("render many.hairloom --record bad.frames" + how + "bad.png");
    EXPECT_EQ(bad.exitCode, 1);
    EXPECT_THAT(bad.errors, HasSubstr("bones"));
    std::ofstream(folder / "short.frames", std::ios::binary) << bytes.substr(0, 52);
    EXPECT_THAT(run("render many.hairloom --record short.frames" + how + "bad.png").errors,
                HasSubstr("cut short"));
}

}  // namespace
}  // namespace hairloom::test
