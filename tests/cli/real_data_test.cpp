// SPDX-License-Identifier: GPL-3.0-or-later
// The whole path on heads and hair from elsewhere, where this checkout has them beside it.

#include <gmock/gmock.h>

#include "core/base/file.h"
#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

class RealData : public CommandLineTest {};

#define HAIRLOOM_NEED_DATA(variable, name)       \
    const std::string variable = dataFile(name); \
    if (variable.empty()) GTEST_SKIP() << "no data beside this checkout: " << (name)

TEST_F(RealData, SintelHeadGrowsHair) {
    HAIRLOOM_NEED_DATA(head, "heads/sintel.obj");
    const auto report = runJson("create --mesh '" + head +
                                "' --scalp above:0.6,cap:100 --count 800 --length 0.2 -o sintel.hairloom");
    EXPECT_EQ(report["strands"], 800);
    EXPECT_EQ(runJson("simulate sintel.hairloom --frames 30 --motion nod --wind 2,0,0")["nan_count"], 0);
    runJson("render sintel.hairloom -o sintel.png --size 160x160");
}

TEST_F(RealData, MakeHumanInDecimetresHasAScalpOf491SquareCentimetres) {
    HAIRLOOM_NEED_DATA(body, "heads/makehuman_base.obj");
    const auto report =
        runJson("create --mesh '" + body +
                "' --unit dm --scalp group:body,above:0.94,cap:90 --count 500 --length 0.1 -o mh.hairloom");
    EXPECT_EQ(report["strands"], 500);
    EXPECT_NEAR(report["scalp_area_cm2"], 491, 5);
    const Outcome plain =
        run("create --mesh '" + body + "' --scalp group:body,above:0.94 --count 10 -o big.hairloom");
    EXPECT_THAT(plain.errors, testing::HasSubstr("dm")) << "17 m is no human: the unit that fits is named";
}

TEST_F(RealData, MakeHumanCollidesWithItsClothes) {
    HAIRLOOM_NEED_DATA(body, "heads/makehuman_base.obj");
    const std::string create = "create --mesh '" + body +
                               "' --unit dm --scalp group:body,above:0.94,cap:90 --count 200 --length 0.3 -o "
                               "mh.hairloom --force --leave-out 'helper*,joint*' --collide-with ";
    const auto clothes = runJson(create + "helper-tights --collide-spheres 64");
    EXPECT_EQ(clothes["spheres"], 64);
    EXPECT_LT(clothes["worst_gap_mm"], 25);
    EXPECT_LT(clothes["mean_gap_mm"], 4);
    EXPECT_EQ(runJson("info mh.hairloom")["scalp"]["groups"], nlohmann::json({"body"}));
    // Groups from a skirt to eyelashes: each has its sphere.
    EXPECT_EQ(runJson(create + "'helper-*' --collide-spheres 1")["spheres"], 13);
    EXPECT_EQ(runJson("simulate mh.hairloom --frames 30 --motion nod")["nan_count"], 0);
}

TEST_F(RealData, ARobotsHeadCollidesWithItsBodyAndDances) {
    HAIRLOOM_NEED_DATA(robot, "animated/raylib_robot.glb");
    const auto head =
        runJson("create --mesh '" + robot +
                "' --leave-out 'Arm*,Foot*,Hand*,Leg*,LowerLeg*' --collide-with 'Torso,Shoulder*' "
                "--collide-spheres 10 --scalp above:0.5,cap:80 --count 50 --length 0.5 -o r.hairloom");
    EXPECT_EQ(head["spheres"], 10);
    EXPECT_EQ(runJson("info r.hairloom")["scalp"]["groups"], nlohmann::json({"Head"}));
    EXPECT_EQ(runJson("simulate r.hairloom --frames 30 --motion clip:Robot_Dance")["nan_count"], 0);
}

TEST_F(RealData, SintelHairComesInMovesAndLeaves) {
    HAIRLOOM_NEED_DATA(hair, "strands/sintel_16pt.tfx");
    const auto imported =
        runJson("import '" + hair + "' --mesh '" + dataFile("heads/sintel.obj") + "' -o s.hairloom");
    EXPECT_EQ(imported["strands"], 11400);
    EXPECT_EQ(imported["points"], 11400 * 16);
    EXPECT_LT(imported["root_distance"]["median_mm"], 0.6);
    EXPECT_NEAR(imported["root_distance"]["max_mm"], 6.23, 0.01);  // by testing every face
    const auto simulated =
        runJson("simulate s.hairloom --frames 120 --fps 60 --wind 2,0,1 --motion nod -o moved.hairloom");
    EXPECT_EQ(simulated["nan_count"], 0);
    EXPECT_LT(simulated["max_stretch"], 0.02);
    for (const char* format : {"hair", "tfx"}) {
        const auto exported =
            runJson(std::string("export moved.hairloom --format ") + format + " -o moved." + format);
        EXPECT_EQ(exported["strands"], 11400);
        EXPECT_LT(exported["max_error_mm"], 1e-3);
    }
    EXPECT_EQ(runJson("render moved.hairloom -o moved.png --size 160x160")["hairs"], 11400);
}

class FieldHeads : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        if (file("head.obj").empty()) GTEST_SKIP() << "no heads from the field";
        runJson("create --mesh '" + file("head.obj") + "' --count 200 --length 0.1 -o g.hairloom");
    }
    std::string file(const std::string& name) const { return dataFile("field/" + name); }
    std::size_t count(const std::string& name, const std::string& text) const {
        const auto bytes = readFile(folder / name).value();
        const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        std::size_t found = 0;
        for (std::size_t at = all.find(text); at != all.npos; at = all.find(text, at + 1)) ++found;
        return found;
    }
};

TEST_F(FieldHeads, OtherUnitsAndAxesArePutRightAndSaid) {
    const auto laid = run("transfer g.hairloom --to '" + file("head_zup.obj") + "' -o z.hairloom --json");
    ASSERT_EQ(laid.exitCode, 0) << laid.errors;
    EXPECT_EQ(laid.json()["head"]["up"], "z");
    EXPECT_LT(laid.json()["max_root_error_mm"], 1);
    EXPECT_THAT(laid.errors, testing::HasSubstr("Z axis"));
    const auto large = run("transfer g.hairloom --to '" + file("head_cm.obj") + "' -o c.hairloom --json");
    ASSERT_EQ(large.exitCode, 0) << large.errors;
    EXPECT_NEAR(large.json()["head"]["metres_per_unit"].get<double>(), 0.01, 1e-6);
    EXPECT_NEAR(large.json()["scale"].get<double>(), 1, 0.01);
    EXPECT_THAT(large.errors, testing::HasSubstr("cm were taken"));
    const std::string inches =
        "import '" + file("inch_zup.hair") + "' --mesh '" + file("head_zup.obj") + "' ";
    const Outcome far = run(inches + "-o i.hairloom");
    EXPECT_EQ(far.exitCode, 1);
    EXPECT_THAT(far.errors, testing::HasSubstr("--unit inch --up z"));
    const auto near = runJson(inches + "--unit inch --up z -o i.hairloom");
    EXPECT_EQ(near["strands"], 40);
    EXPECT_LT(near["root_distance"]["max_mm"], 1);
}

TEST_F(FieldHeads, AHeadWithoutUvsGivesUnrealNoRootUvs) {
    runJson("create --mesh '" + file("head_no_uv.obj") + "' --count 50 --length 0.1 -o bare.hairloom");
    runJson("export bare.hairloom --target unreal -o bare.abc");
    EXPECT_EQ(count("bare.abc", "groom_root_uv"), 0u);
    runJson("export g.hairloom --target unreal -o with.abc");
    EXPECT_GE(count("with.abc", "groom_root_uv"), 1u);
}

TEST_F(FieldHeads, HairsForUnrealNameTheirGuides) {
    runJson("guides g.hairloom --count 30 -o guides.hairloom");
    const auto exported = runJson("export guides.hairloom --what hairs --target unreal -o hairs.abc");
    for (const char* name : {"groom_guide", "groom_closest_guides", "groom_guide_weights"})
        EXPECT_GE(count("hairs.abc", name), 1u) << name;
    EXPECT_EQ(runJson("import hairs.abc -o back.hairloom")["strands"], exported["strands"]);
    EXPECT_EQ(runJson("info back.hairloom")["guides"], 30);
}

}  // namespace
}  // namespace hairloom::test
