// SPDX-License-Identifier: GPL-3.0-or-later
// Operators on the command line: copied between projects, masked, alone; guides and shapes that are taken.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "core/operations/painted_maps.h"
#include "core/operations/stack.h"
#include "core/render/png.h"
#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

class OperatorsCli : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        runJson(createArguments());
        std::ofstream(folder / "stack.json") << R"({"operators": [
            {"op": "flow", "gravity": 0.9},
            {"op": "curl", "mask": {"map": "density", "ramp": [[0, 0], [1, 1]]}},
            {"op": "part", "curve": [[0, 1.74, 0.08], [0, 1.78, 0], [0, 1.76, -0.06]]}]})";
        runJson("stack hair.hairloom --from stack.json -o styled.hairloom");
    }
    std::size_t enabled(const std::string& project) {
        std::size_t count = 0;
        const auto shown = runJson("stack " + project);
        for (const auto& one : shown["operators"]) count += one["enabled"].get<bool>();
        return count;
    }
};

TEST_F(OperatorsCli, StacksAreKeptAndAddedToOtherHair) {
    const auto kept = runJson("stack styled.hairloom --only 1 --keep curl.stack.json");
    ASSERT_EQ(kept["operators"].size(), 1u);
    EXPECT_EQ(kept["operators"][0]["mask"]["map"], "density");
    const auto added = runJson("stack hair.hairloom --add curl.stack.json -o other.hairloom");
    EXPECT_EQ(added["operators"], kept["operators"]);
    const auto before = runJson("stack styled.hairloom --add curl.stack.json --at 0 -o more.hairloom");
    ASSERT_EQ(before["operators"].size(), 4u);
    EXPECT_EQ(before["operators"][0], kept["operators"][0]);
    const Outcome outcome = run("stack styled.hairloom --only 9");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("operator 9 does not exist; there are 3 operators"));
    EXPECT_EQ(run("stack styled.hairloom --solo 0").exitCode, 2) << "needs -o";
}

TEST_F(OperatorsCli, AnImageBecomesAMaskAndADensity) {
    // Stripes, so that some roots are on black and some on white, wherever the scalp lies in it.
    render::Image image{16, 1, {}};
    for (int x = 0; x < 16; ++x) image.rgba.insert(image.rgba.end(), 4, x % 2 == 0 ? 0 : 255);
    for (int x = 0; x < 16; ++x) image.rgba[static_cast<std::size_t>(4 * x + 3)] = 255;
    ASSERT_TRUE(render::writePng(folder / "half.png", image));
    std::ofstream(folder / "broken.png") << "no picture";
    std::ofstream(folder / "curl.json") << R"({"operators": [{"op": "curl", "mask": {"map": "mask2"}}]})";
    const std::string stack = " --from curl.json -o masked.hairloom --force --mask 2 --mask-image ";
    EXPECT_THAT(run("stack hair.hairloom" + stack + "broken.png").errors, HasSubstr("error: broken.png: "));
    EXPECT_EQ(run("stack hair.hairloom --mask 2 -o masked.hairloom").exitCode, 2) << "needs an image";
    runJson("stack hair.hairloom" + stack + "half.png");
    runJson("stack hair.hairloom --from curl.json -o bare.hairloom");
    EXPECT_TRUE(readText(folder / "masked.hairloom") != readText(folder / "bare.hairloom"));
    EXPECT_THAT(run(createArguments("") + " --mask broken.png").errors, HasSubstr("error: broken.png"));

    // Without a number it takes what nothing uses.
    const std::string fill = " --mask-image half.png -o filled.hairloom --force";
    EXPECT_EQ(runJson("stack masked.hairloom" + fill)["mask"], 1);
    for (const int next : {3, 4}) {
        EXPECT_EQ(runJson("stack filled.hairloom" + fill)["mask"], next) << "the curl has 2";
    }
    EXPECT_THAT(run("stack filled.hairloom" + fill).errors, HasSubstr("all 4 masks are in use"));
    EXPECT_EQ(runJson("stack filled.hairloom --mask 3" + fill)["mask"], 3);
}

TEST_F(OperatorsCli, MasksHaveNames) {
    EXPECT_TRUE(runJson("stack hair.hairloom")["masks"].empty()) << "nothing is painted or named";
    EXPECT_EQ(runJson("set hair.hairloom masks.1=Fringe -o named.hairloom")["changed"], 1);
    const auto masks = runJson("stack named.hairloom")["masks"];
    ASSERT_EQ(masks.size(), 1u);
    EXPECT_EQ(masks[0]["mask"], 1);
    EXPECT_EQ(masks[0]["name"], "Fringe");
    EXPECT_EQ(masks[0]["strands"], 0);
    EXPECT_EQ(runJson("info --diff hair.hairloom named.hairloom")["differences"][0]["where"], "masks");
    runJson("set named.hairloom masks.1= -o unnamed.hairloom");
    EXPECT_TRUE(runJson("info --diff hair.hairloom unnamed.hairloom")["differences"].empty());
    // A name that no groom could have is wrong usage, one that another mask of this one has is an error.
    EXPECT_EQ(run("set hair.hairloom masks.5=Nape -o bad.hairloom").exitCode, 2);
    EXPECT_EQ(run("set hair.hairloom masks.2=7 -o bad.hairloom").exitCode, 2);
    const Outcome twice = run("set named.hairloom masks.2=fringe -o bad.hairloom");
    EXPECT_EQ(twice.exitCode, 1);
    EXPECT_THAT(twice.errors, HasSubstr("masks 1 and 2 are both called 'fringe'"));
    const std::string fill = " --mask-image none.png -o bad.hairloom";
    EXPECT_EQ(run("stack hair.hairloom --mask 9" + fill).exitCode, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "bad.hairloom"));
}

TEST_F(OperatorsCli, EachColourOfAnImageBecomesAMask) {
    // Stripes of four colours, the last of them black; each fourth pixel of the red ones is a shade of it.
    const std::uint8_t stripes[4][3] = {{255, 0, 0}, {0, 0, 255}, {0x12, 0x80, 0x40}, {0, 0, 0}};
    render::Image image{64, 64, {}};
    for (int i = 0; i < 64 * 64; ++i) {
        const int stripe = i % 64 / 4 % 4;
        for (int c = 0; c < 3; ++c) {
            const std::uint8_t value = stripes[stripe][c];
            image.rgba.push_back(i % 64 % 16 == 0 && c == 0 ? static_cast<std::uint8_t>(155 + i / 64)
                                                            : value);
        }
        image.rgba.push_back(255);
    }
    ASSERT_TRUE(render::writePng(folder / "regions.png", image));
    const std::string fill = " --regions-image regions.png -o regions.hairloom --force";
    const auto filled = runJson("stack hair.hairloom" + fill)["regions"];
    ASSERT_EQ(filled.size(), 3u) << filled;
    const char* const names[] = {"red", "#128040", "blue"};
    int strands = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(filled[i]["colour"], names[i]);
        EXPECT_EQ(filled[i]["mask"], i + 1);
        EXPECT_GT(filled[i]["strands"], 0);
        strands += filled[i]["strands"].get<int>();
    }
    const int all = runJson("info hair.hairloom")["strands"];
    EXPECT_LT(strands, all) << "some roots are on black";
    const auto groom = openProject(folder / "regions.hairloom");
    ASSERT_TRUE(groom) << groom.error().message();
    std::vector<int> in(groom->strandCount(), 0);
    for (const std::uint32_t number : {1u, 2u, 3u}) {
        const auto mask = groom->strandAttributes.view<float>(maskAttribute(number));
        ASSERT_EQ(mask.size(), in.size());
        for (std::size_t s = 0; s < in.size(); ++s) in[s] += mask[s] == 1.0f;
        EXPECT_EQ(std::ranges::count(mask, 1.0f), filled[number - 1]["strands"].get<int>());
    }
    EXPECT_EQ(std::ranges::max(in), 1) << "no strand is in two regions";

    const auto masks = runJson("stack regions.hairloom")["masks"];
    ASSERT_EQ(masks.size(), 3u) << masks;
    EXPECT_EQ(masks[1]["name"], "#128040") << "that of its colour";
    EXPECT_EQ(masks[1]["strands"], filled[1]["strands"]);
    runJson("set regions.hairloom 'masks.2=Nape, left' masks.4=Beard -o named.hairloom");
    const auto again =
        runJson("stack named.hairloom --mask 'nape, LEFT' --regions-image regions.png -o again.hairloom");
    EXPECT_EQ(again["regions"][0]["mask"], 2);
    const char* const refilled[] = {"red", "Nape, left", "#128040", "Beard"};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(again["masks"][i]["name"], refilled[i]) << "what somebody has called it stays";

    EXPECT_THAT(run("stack regions.hairloom" + fill).errors,
                HasSubstr("regions.png: 3 regions need a mask each, and 1 of 4 are free"));
    EXPECT_EQ(runJson("stack regions.hairloom --mask 2" + fill)["regions"][2]["mask"], 4);
    EXPECT_THAT(run("stack regions.hairloom --mask 3" + fill).errors, HasSubstr("2 of 4 begin at 3"));
    EXPECT_EQ(run("stack hair.hairloom --mask-image regions.png" + fill).exitCode, 2);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<std::uint8_t>(i * 37 / 11);
    ASSERT_TRUE(render::writePng(folder / "regions.png", image));
    EXPECT_THAT(run("stack hair.hairloom" + fill).errors, HasSubstr("expected regions of one colour each"));
    std::ranges::fill(image.rgba, std::uint8_t{0});
    ASSERT_TRUE(render::writePng(folder / "regions.png", image));
    EXPECT_THAT(run("stack hair.hairloom" + fill).errors,
                HasSubstr("no regions: it is black or transparent"));
}

TEST_F(OperatorsCli, AHeadIsTurnedAndTakenWithoutHelpers) {
    const std::string head =
        "create --mesh '" + bustFile() + "' --count 20 --length 0.1 -o turned.hairloom --force ";
    runJson(head + "--up z --leave-out bust_shoulders,bust_neck --scalp group:bust_scalp");
    const auto turned = runJson("info turned.hairloom")["bounds"];
    runJson(head + "--scalp group:bust_scalp");
    EXPECT_NE(turned, runJson("info turned.hairloom")["bounds"]);
    EXPECT_THAT(run(head + "--leave-out nose").errors, HasSubstr("nose"));
    EXPECT_EQ(run(head + "--up x").exitCode, 2);
}

TEST_F(OperatorsCli, HairCollidesWithGroupsThatAreNoPartOfTheHead) {
    const std::string head =
        "create --mesh '" + bustFile() +
        "' --count 20 --length 0.1 --scalp group:bust_scalp -o dressed.hairloom --force ";
    EXPECT_EQ(runJson(head)["spheres"], 0);
    const auto report =
        runJson(head + "--leave-out bust_neck --collide-with bust_shoulders --collide-spheres 7");
    EXPECT_EQ(report["spheres"], 7);
    EXPECT_GT(report["worst_gap_mm"], report["mean_gap_mm"]);
    EXPECT_LT(report["worst_gap_mm"], 60);
    const auto info = runJson("info dressed.hairloom");
    EXPECT_EQ(info["spheres"], 7);
    EXPECT_EQ(info["scalp"]["groups"], nlohmann::json({"bust_scalp", "bust_face", "bust_ears"}));
    // The skeleton came along, and moves the spheres.
    const auto moved = runJson("simulate dressed.hairloom --motion clip:nod_and_turn --frames 20");
    EXPECT_EQ(moved["nan_count"], 0);
    const auto fitted = runJson("spheres dressed.hairloom --fit 3 --replace -o more.hairloom");
    EXPECT_EQ(fitted["spheres"], 10) << "those of the group stay";
    EXPECT_EQ(fitted["on_bones"], 3);
    const auto again = runJson("spheres more.hairloom --fit 2 --replace -o more.hairloom --force");
    EXPECT_EQ(again["spheres"], 9);

    EXPECT_THAT(run(head + "--collide-with coat").errors,
                HasSubstr("no group 'coat'; expected one of: bust_ears"));
    EXPECT_THAT(run(head + "--collide-with 'bust*'").errors, HasSubstr("no head is left"));
    EXPECT_EQ(run(head + "--collide-with bust_neck --collide-spheres 257").exitCode, 2);
    EXPECT_EQ(run(head + "--collide-spheres 4").exitCode, 2) << "of what?";
}

TEST_F(OperatorsCli, OneActsAloneIsDuplicatedAndRemoved) {
    runJson("stack styled.hairloom --solo 1 -o solo.hairloom");
    EXPECT_EQ(enabled("solo.hairloom"), 1u);
    runJson("stack solo.hairloom --solo 1 -o all.hairloom");
    EXPECT_EQ(readText(folder / "all.hairloom"), readText(folder / "styled.hairloom"));
    const auto twice = runJson("stack styled.hairloom --duplicate 2 --remove 0 -o twice.hairloom");
    ASSERT_EQ(twice["operators"].size(), 3u);
    EXPECT_EQ(twice["operators"][1], twice["operators"][2]);
}

TEST_F(OperatorsCli, GuidesStandForAllStrands) {
    const auto few = runJson("guides styled.hairloom --count 10");
    const auto many = runJson("guides styled.hairloom --count 40 -o guides.hairloom");
    EXPECT_EQ(many["guides"], 40);
    EXPECT_LT(many["mean_mm"].get<double>(), few["mean_mm"].get<double>());
    EXPECT_LE(many["mean_mm"].get<double>(), many["max_mm"].get<double>());
    EXPECT_EQ(runJson("info guides.hairloom")["strands"], 40);
    EXPECT_TRUE(runJson("validate guides.hairloom")["valid"].get<bool>());
    runJson("guides styled.hairloom --count 40 --all -o marked.hairloom");
    const auto marked = runJson("info marked.hairloom");
    EXPECT_EQ(marked["guides"], 40);
    EXPECT_EQ(marked["strands"], many["strands"]);
    runJson("guides styled.hairloom --count 40 --threads 1 -o again.hairloom");
    EXPECT_EQ(readText(folder / "guides.hairloom"), readText(folder / "again.hairloom"));
}

TEST_F(OperatorsCli, AFrameOfTheSimulationIsTakenAsTheShape) {
    const auto taken =
        runJson("simulate styled.hairloom --frames 20 --motion nod --wind 4,0,0 --take -o taken.hairloom");
    EXPECT_LT(taken["sag"]["mean_mm"].get<double>(), 1) << "it holds";
    const auto operators = runJson("stack taken.hairloom")["operators"];
    ASSERT_EQ(operators.size(), 4u);
    EXPECT_EQ(operators[3]["op"], "sculpt");
    EXPECT_TRUE(runJson("validate taken.hairloom")["valid"].get<bool>());
    EXPECT_EQ(run("simulate styled.hairloom --frames 2 --take").exitCode, 2) << "needs -o";
}

}  // namespace
}  // namespace hairloom::test
