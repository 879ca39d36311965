// SPDX-License-Identifier: GPL-3.0-or-later
// What a hairstyle withstands and costs, and how it leaves: for other heads, other programs, layer by layer.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "importers/scene.h"
#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class Hairstyle : public CommandLineTest {};

TEST_F(Hairstyle, StabilityOfAGroomIsItsCertificate) {
    runJson(createArguments("", 7, 20));
    const auto certificate = runJson("stability hair.hairloom -o out --storms 20")["certificate"];
    EXPECT_EQ(certificate["storms"], 20);
    EXPECT_EQ(certificate["failed"], 0) << certificate.dump(2);
    for (const char* limit : {"largest_step_s", "root_speed", "turn", "wind", "margin"})
        EXPECT_GT(certificate[limit].get<double>(), 0) << limit;
    EXPECT_EQ(nlohmann::json::parse(readText(folder / "out/certificate.json")), certificate);
    EXPECT_EQ(run("stability hair.hairloom -o out --integrators rk4").exitCode, 2);
    EXPECT_THAT(run("stability none.hairloom -o other").errors, StartsWith("error: none.hairloom"));
    EXPECT_FALSE(fs::exists(folder / "other"));
}

TEST_F(Hairstyle, BudgetIsSharedByCharactersAndTimedAgain) {
    runJson(createArguments("", 7, 20));
    const auto budget =
        runJson("budget hair.hairloom --ms 1000 --characters 10 --frames 4 --repeat 1 --truth engine --busy");
    EXPECT_EQ(budget["characters"], 10);
    EXPECT_LE(budget["ms"].get<double>(), 1000);
    EXPECT_GT(budget["ms_again"].get<double>(), 0);
    EXPECT_GE(budget["spread_share"].get<double>(), 0);
    // Which one is cheapest is up to the machine (accuracy/choice_test has it for known times).
    const auto within =
        runJson("budget hair.hairloom --within-mm 1000 --frames 4 --repeat 1 --truth engine --busy");
    EXPECT_LE(within["error_mm"].get<double>(), 1000);
    EXPECT_EQ(run("budget hair.hairloom --frames 4").exitCode, 2) << "neither time nor error";
    EXPECT_EQ(run("budget hair.hairloom --ms 1 --within-mm 1").exitCode, 2);
    EXPECT_EQ(run("budget hair.hairloom --ms 1 --size 64x64").exitCode, 2) << "nothing is drawn";
}

TEST_F(Hairstyle, ABudgetOfWholeFramesCountsDrawing) {
    runJson(createArguments("", 7, 20));
    const auto budget = runJson(
        "budget hair.hairloom --ms 1e5 --device 0 --size 64x64 --frames 4 --repeat 1 --truth engine --busy");
    EXPECT_FALSE(budget["device"].get<std::string>().empty());
    EXPECT_GT(budget["frame"]["draw_ms"].get<double>(), 0);
    EXPECT_NEAR(budget["frame"]["frame_ms"].get<double>(), budget["ms_again"].get<double>(), 1e-6);
}

TEST_F(Hairstyle, SettingsOfThePictureHavePricesToo) {
    runJson(createArguments("", 7, 20));
    // Light in a volume takes seconds a picture on a software device: it is in one run and the exact picture.
    const auto report = runJson(
        "accuracy hair.hairloom --picture -o out --size 48x48 --passes 2 --repeat 1 --shading marschner "
        "--scatter dual");
    std::map<std::string, int> now;
    for (const auto& run : report["picture"]) {
        EXPECT_GT(run["ms"].get<double>(), 0);
        EXPECT_GE(run["flip"].get<double>(), 0);
        now[run["setting"]] += run["now"].get<bool>();
        if (run["now"] && run["setting"] == "scattering") {
            EXPECT_EQ(run["value"], "dual");
        }
    }
    for (const char* setting : {"samples", "filter", "transparency", "ribbons", "subdivisions", "shadows",
                                "shadowResolution", "scattering"})
        EXPECT_EQ(now[setting], 1) << setting;
    for (const char* file : {"picture.csv", "picture.svg", "report.html"})
        EXPECT_TRUE(fs::exists(folder / "out" / file)) << file;
    EXPECT_EQ(run("accuracy hair.hairloom -o out --size 48x48").exitCode, 2) << "only of pictures";
}

TEST_F(Hairstyle, AStyleIsTransferredToAnotherHeadAndSimulatedThere) {
    runJson(createArguments());
    // The same head, twice the size, with other triangles: vertices in another order.
    const auto head = importScene(bustFile());
    ASSERT_TRUE(head);
    std::ofstream obj(folder / "large.obj");
    const auto positions = head->mesh.positions();
    for (std::size_t v = positions.size(); v-- > 0;) {
        const Vec3f p = 2 * positions[v];
        obj << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
    for (const Triangle& t : head->mesh.triangles()) {
        obj << 'f';
        for (const std::uint32_t v : t) obj << ' ' << positions.size() - v;
        obj << '\n';
    }
    obj.close();
    const auto report = runJson("transfer hair.hairloom --to large.obj -o large.hairloom");
    EXPECT_EQ(report["strands"], 300);
    EXPECT_FALSE(report["same_mesh"].get<bool>());
    EXPECT_NEAR(report["scale"].get<double>(), 2, 0.05);
    EXPECT_LT(report["max_root_error_mm"].get<double>(), 5);
    EXPECT_TRUE(report["strands_named"].is_array());
    EXPECT_EQ(runJson("simulate large.hairloom --frames 3 --motion nod")["nan_count"], 0);
    EXPECT_TRUE(runJson("validate large.hairloom")["valid"].get<bool>());
    EXPECT_EQ(run("transfer hair.hairloom --to none.obj -o x.hairloom").exitCode, 1);
}

TEST_F(Hairstyle, MovingHairIsExportedAndComesBack) {
    runJson(createArguments("", 7, 20));
    runJson("set hair.hairloom interpolation.followPerGuide=3 -o hair.hairloom");
    runJson("simulate hair.hairloom --frames 6 --motion nod --record run.frames");
    for (const char* const format : {"abc", "usda", "usdc"}) {
        const auto report = runJson(
            std::string("export hair.hairloom --what hairs --record run.frames --frames 1,5 --format ") +
            format + " -o moving." + format);
        EXPECT_EQ(report["strands"], 900) << format;
        EXPECT_EQ(report["frames"], 5) << format;
        EXPECT_LT(report["max_error_mm"].get<double>(), 0.001) << format;
        const auto back =
            runJson(std::string("import moving.") + format + " --record back.frames -o back.hairloom");
        EXPECT_EQ(back["frames"], 5) << format;
    }
    const std::string one = " hair.hairloom --record run.frames --format hair -o h.hair --frames ";
    EXPECT_EQ(runJson("export" + one + "3,3")["strands"], 300) << "one frame is a shape";
    EXPECT_THAT(run("export" + one + "1,3").errors, HasSubstr("hair holds a single pose"));
    EXPECT_THAT(run("export" + one + "1,99").errors, HasSubstr("frames"));
    EXPECT_EQ(run("export hair.hairloom --record run.frames --format abc -o m.abc").exitCode, 2)
        << "which frames";
}

TEST_F(Hairstyle, LayersAreMadeByScriptsShownAndExportedAlone) {
    runJson(createArguments());
    std::ofstream(folder / "layers.json") << R"({"hairloom_script": 1, "operations": [
        {"op": "layers", "layers": [{"name": "Hair", "visible": true, "locked": false},
                                    {"name": "Fringe", "visible": true, "locked": false}]},
        {"op": "move_to_layer", "strands": [10, 20], "layer": 1},
        {"op": "operators", "operators": [{"op": "noise", "region": {"layer": 2}}, {"op": "smooth"}]}]})";
    runJson("groom hair.hairloom --script layers.json -o hair.hairloom");
    const auto layers = runJson("layers hair.hairloom")["layers"];
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers[1]["name"], "Fringe");
    EXPECT_EQ(layers[1]["strands"], 20);
    EXPECT_EQ(layers[1]["points"], 20 * 12);
    EXPECT_EQ(layers[1]["density"], 1);
    EXPECT_EQ(layers[1]["own_material"], false);
    EXPECT_EQ(layers[0]["operators"], nlohmann::json({1}));
    EXPECT_EQ(layers[1]["operators"], nlohmann::json({0, 1}));
    EXPECT_EQ(runJson("stack hair.hairloom --layer Hair")["operators"].size(), 1u);
    EXPECT_EQ(runJson("export hair.hairloom --layers Fringe --format obj-lines -o f.obj")["strands"], 20);
    EXPECT_EQ(runJson("export hair.hairloom --layers Hair,Fringe --format obj-c4d -o a.obj")["strands"], 300);
    EXPECT_EQ(runJson("import a.obj -o back.hairloom")["strands"], 300);
    EXPECT_THAT(run("export hair.hairloom --layers Beard --format hair -o b.hair").errors,
                HasSubstr("no layer is called 'Beard'; expected some of Hair, Fringe"));

    EXPECT_EQ(runJson("set hair.hairloom interpolation.followPerGuide=8 layers.Fringe.density=0.5 "
                      "layers.Fringe.material.rootColour=[0.9,0.1,0.1] layers.Fringe.material.specular=1 "
                      "-o red.hairloom")["changed"],
              4);
    const auto red = runJson("layers red.hairloom")["layers"];
    EXPECT_EQ(red[1]["density"], 0.5);
    EXPECT_EQ(red[1]["own_material"], true);
    EXPECT_EQ(red[0]["own_material"], false);
    const auto hairs = runJson("export red.hairloom --what hairs --format abc -o red.abc");
    const std::vector<std::string> names = hairs["names"];
    EXPECT_THAT(names, testing::Contains("groom_id"));
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    const std::vector<std::string> unreal = runJson("export red.hairloom --target unreal -o u.abc")["names"];
    EXPECT_EQ(std::ranges::count(unreal, "groom_group_name"), 1);
    EXPECT_TRUE(runJson("import red.abc -o again.hairloom")["resampled_fps"].is_null());
    EXPECT_EQ(hairs["strands"], 280 * 8 + 20 * 4);
    EXPECT_EQ(runJson("export red.hairloom --format runtime -o red.hairrt")["strands"], 300);
    runJson("import red.hairrt -o red_back.hairloom");
    EXPECT_EQ(runJson("layers red_back.hairloom")["layers"][1]["own_material"], true);
    runJson("set red.hairloom layers.Fringe.material=null -o plain.hairloom");
    EXPECT_EQ(runJson("layers plain.hairloom")["layers"][1]["own_material"], false);
    EXPECT_THAT(run("set red.hairloom layers.Beard.density=1 -o b.hairloom").errors,
                HasSubstr("/layers/Beard is not a layer"));
    EXPECT_THAT(run("set red.hairloom layers.Fringe.density=9 -o b.hairloom").errors,
                HasSubstr("/layers/Fringe/density is 9"));
    EXPECT_THAT(run("set red.hairloom layers.Fringe=1 -o b.hairloom").errors, HasSubstr("/layers/Fringe"));
    EXPECT_THAT(run("set red.hairloom layers.Fringe.colour=1 -o b.hairloom").errors,
                HasSubstr("colour is not known"));
}

}  // namespace
}  // namespace hairloom::test
