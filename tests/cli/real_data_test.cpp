// SPDX-License-Identifier: GPL-3.0-or-later
// The whole path on heads and hair from elsewhere, where this checkout has them beside it.

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace hairloom::test
