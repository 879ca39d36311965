// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures from the command line: what views may say, sequences, and the plan.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class RenderJob : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        runJson("create --mesh '" + bustFile() +
                "' --scalp material:scalp --count 60 --length 0.2 --points 6 -o hair.hairloom");
    }
    std::string view(const std::string& name, const std::string& content) const {
        std::ofstream(folder / name) << content;
        return " --view " + name;
    }
    nlohmann::json picture(const std::string& more) const {
        return runJson("render hair.hairloom -o hair.png --size 48x48 --passes 1 " + more);
    }
    /// Names of what a report's plan has made.
    static std::set<std::string> targets(const nlohmann::json& report) {
        std::set<std::string> names;
        for (const char* const kind : {"targets", "buffers"}) {
            for (const auto& made : report["plan"][kind]) names.insert(made["name"]);
        }
        return names;
    }
};

TEST_F(RenderJob, PlansHoldOnlyWhatIsUsed) {
    EXPECT_TRUE(targets(picture("")).contains("opacity layers"));
    EXPECT_FALSE(targets(picture("--shadow absorption")).contains("opacity layers"));
    EXPECT_FALSE(targets(picture("--ribbons compute --transparency stochastic")).contains("depth"));
    EXPECT_EQ(picture("--shading kajiya")["plan"]["tables"]["bytes"], 0);
    EXPECT_GT(picture("--shading marschner")["plan"]["tables"]["bytes"], 100'000);
    EXPECT_FALSE(targets(picture("--shadow none")).contains("head depth"));
    const auto dark = picture(view("dark.json", R"({"lights": []})"));
    EXPECT_FALSE(targets(dark).contains("head depth"));
    for (const auto& pass : dark["plan"]["passes"]) EXPECT_FALSE(pass["why"].get<std::string>().empty());
    const auto unshadowed = picture(view(
        "plain.json",
        R"({"lights": [{"type": "directional", "to_light": [0, 1, 1], "irradiance": [3, 3, 3], "shadow": false}]})"));
    EXPECT_FALSE(targets(unshadowed).contains("head depth"));
}

TEST_F(RenderJob, EachWayOfDrawingGivesItsOwnPicture) {
    std::set<std::string> pictures;
    const std::vector<std::string> ways = {
        "",
        "--shadow none",
        "--shadow absorption",
        "--shadow opacity",
        "--aa fxaa",
        "--aa none",
        "--transparency weighted",
        "--detail 5",
        view("point.json",
             R"({"lights": [{"type": "point", "position": [0, 2.2, 1], "intensity": [3, 3, 3]}]})"),
        view("flat.json",
             R"({"camera": {"eye": [0, 1.6, 1], "target": [0, 1.6, 0], "orthographic_height": 0.5}})"),
        view("deep.json", R"({"camera": {"eye": [0, 1.6, 1], "target": [0, 1.6, 0], "fov_y_deg": 28.07}})"),
        view("around.json", R"({"lights": [{"type": "environment", "radiance": [0.3, 0.3, 0.3]}]})"),
        view("sky.json", R"({"lights": [{"type": "environment", "sky": [0, 0, 1], "ground": [1, 0, 0]}]})")};
    for (const std::string& way : ways) {
        picture(way);
        pictures.insert(readText(folder / "hair.png"));
    }
    EXPECT_EQ(pictures.size(), ways.size());
    // A picture serves as light from around.
    std::filesystem::copy_file(folder / "hair.png", folder / "sky.png");
    picture(view("image.json", R"({"lights": [{"type": "environment", "image": "sky.png", "scale": 2}]})"));
}

TEST_F(RenderJob, EccentricFibresLookOtherwiseInEachModel) {
    const auto drawn = [&](const std::string& model, const std::string& eccentricity) {
        runJson("set hair.hairloom material.eccentricity=" + eccentricity + " -o other.hairloom");
        runJson("render other.hairloom -o hair.png --size 96x96 --passes 1 --engine software --shading " +
                model);
        return readText(folder / "hair.png");
    };
    for (const std::string model : {"kajiya", "marschner", "sadeghi"}) {
        const std::string round = drawn(model, "0");
        EXPECT_EQ(drawn(model, "0"), round) << model;
        EXPECT_NE(drawn(model, "0.6"), round) << model;
        EXPECT_NE(drawn(model, "0.8"), drawn(model, "0.6")) << model;
    }
}

TEST_F(RenderJob, CausticsShowInPictures) {
    const auto drawn = [&](const std::string& fields) {
        runJson(
            "set hair.hairloom material.shadingModel=marschner material.azimuthalRoughness=0.01 "
            "material.eumelanin=0.1 material.rootRadius=0.0006 " +
            fields + " -o other.hairloom");
        runJson("render other.hairloom -o hair.png --size 96x96 --passes 1 --engine software");
        return readText(folder / "hair.png");
    };
    const std::string usual = drawn("");
    EXPECT_EQ(drawn("material.causticFade=0.3 material.causticIntensity=1"), usual);
    std::set<std::string> pictures{usual};
    const std::vector<std::string> ways{"material.causticWidthDegrees=2",
                                        "material.causticWidthDegrees=60",
                                        "material.causticFade=1 material.causticIntensity=9",
                                        "material.causticIntensity=0",
                                        "material.causticIntensity=10",
                                        "material.azimuthalSolver=cubic"};
    for (const std::string& way : ways) pictures.insert(drawn(way));
    EXPECT_EQ(pictures.size(), ways.size() + 1);
    for (const char* const wrong :
         {"causticWidthDegrees=61", "causticFade=-0.1", "causticIntensity=11", "azimuthalSolver=quartic"})
        EXPECT_NE(run(std::string("set hair.hairloom -o x.hairloom material.") + wrong).exitCode, 0) << wrong;
}

TEST_F(RenderJob, AViewSetsShadowMapsAndCurvesAndOptionsOverrideIt) {
    const auto drawn = [&](const std::string& way) {
        picture("--engine software" + way);
        return readText(folder / "hair.png");
    };
    const std::string usual = drawn("");
    EXPECT_EQ(drawn(" --shadow-resolution 1024 --subdivisions 2"), usual);
    const std::string coarse = view("coarse.json", R"({"shadow_resolution": 64})");
    const std::string smooth = view("smooth.json", R"({"subdivisions": 8})");
    EXPECT_NE(drawn(coarse), usual);
    EXPECT_EQ(drawn(coarse), drawn(" --shadow-resolution 64"));
    EXPECT_EQ(drawn(coarse + " --shadow-resolution 1024"), usual);
    EXPECT_NE(drawn(smooth), usual);
    EXPECT_EQ(drawn(smooth), drawn(" --subdivisions 8"));
    EXPECT_EQ(drawn(smooth + " --subdivisions 2"), usual);
    const std::string filtered = view("filtered.json", R"({"shadow_filter": "5x5"})");
    EXPECT_EQ(drawn(" --shadow-filter 3x3"), usual);
    EXPECT_NE(drawn(filtered), usual);
    EXPECT_EQ(drawn(filtered), drawn(" --shadow-filter 5x5"));
    EXPECT_EQ(drawn(filtered + " --shadow-filter 3x3"), usual);
    EXPECT_NE(drawn(" --shadow-filter off"), usual);
    for (const char* const wrong : {"--shadow-resolution 63", "--shadow-resolution 4097", "--subdivisions 0"})
        EXPECT_EQ(run(std::string("render hair.hairloom -o x.png ") + wrong).exitCode, 2) << wrong;
}

TEST_F(RenderJob, ShadowsAreSavedInTheProjectAndViewsAndOptionsOverrideThem) {
    runJson("create --mesh '" + bustFile() +
            "' --scalp material:scalp --count 3000 --length 0.05 --points 4 -o hair.hairloom");
    const auto drawn = [&](const std::string& fields, const std::string& way = "") {
        runJson("set hair.hairloom material.rootRadius=0.0005 material.eumelanin=0 " + fields +
                " -o other.hairloom");
        const auto report = runJson(
            "render other.hairloom -o hair.png --size 96x96 --passes 1 --engine software --shading "
            "marschner " +
            way);
        return std::pair(readText(folder / "hair.png"), report);
    };
    const std::string usual = drawn("shadows.kind=deepOpacity").first;
    const std::pair<const char*, const char*> same[] = {
        {"shadows.kind=none", "--shadow none"},
        {"shadows.kind=absorption", "--shadow absorption"},
        {"shadows.kind=opacityMaps", "--shadow opacity"},
        {"shadows.kind=opacityMaps shadows.slices=9", "--shadow opacity --shadow-slices 9"},
        {"shadows.kind=adaptive", "--shadow adaptive"},
        {"shadows.kind=adaptive shadows.nodes=16", "--shadow adaptive --shadow-nodes 16"},
        {"shadows.filter=5x5", "--shadow-filter 5x5"},
        {"shadows.resolution=128", "--shadow-resolution 128"},
        {"shadows.layers=7", "--shadow-layers 7"},
        {"shadows.layers=11 shadows.layerEnds=linear", "--shadow-layers 11 --layer-ends linear"},
        {"shadows.layerEnds=growing shadows.layerGrowth=3", "--layer-ends growing --layer-growth 3"},
        {"shadows.headAbsorption=50", "--head-absorption 50"},
        {"shadows.blur=2", "--shadow-blur 2"}};
    std::set<std::string> pictures{usual};
    for (const auto& [saved, option] : same) {
        const std::string picture = drawn(saved).first;
        EXPECT_EQ(picture, drawn("shadows.kind=deepOpacity", option).first) << saved;
        EXPECT_TRUE(pictures.insert(picture).second) << saved << " looks as another";
    }
    const std::string asUsual =
        view("usual.json", R"({"shadow": "dom", "shadow_layers": 3, "layer_ends": "early",
        "shadow_filter": "3x3", "shadow_resolution": 1024})");
    EXPECT_EQ(
        drawn("shadows.layers=11 shadows.layerEnds=linear shadows.filter=off shadows.resolution=64", asUsual)
            .first,
        usual);
    EXPECT_EQ(drawn("shadows.layers=11", asUsual + " --shadow none").first, drawn("shadows.kind=none").first);
    const std::string layered =
        view("layered.json", R"({"layer_ends": "growing", "layer_growth": 3, "shadow_slices": 5})");
    EXPECT_EQ(drawn("shadows.kind=deepOpacity", layered).first,
              drawn("shadows.layerEnds=growing shadows.layerGrowth=3").first);
    const std::string noded = view("noded.json", R"({"shadow": "adaptive", "shadow_nodes": 16})");
    EXPECT_EQ(drawn("shadows.kind=deepOpacity", noded).first,
              drawn("shadows.kind=adaptive shadows.nodes=16").first);
    EXPECT_THAT(drawn("shadows.kind=adaptive").second["plan"].dump(),
                HasSubstr("keeps 8 nodes of its transmittance"));
    const auto plan = drawn("shadows.layers=11").second["plan"].dump();
    EXPECT_THAT(plan, HasSubstr("counts hair in 11 layers"));
    for (const char* const wrong :
         {"shadows.layers=2", "shadows.layers=12", "shadows.slices=0", "shadows.slices=17", "shadows.nodes=3",
          "shadows.nodes=17", "shadows.layerGrowth=0.5", "shadows.kind=moon", "shadows.resolution=63"})
        EXPECT_NE(run(std::string("set hair.hairloom -o x.hairloom ") + wrong).exitCode, 0) << wrong;
    for (const char* const wrong :
         {"--shadow-layers 2", "--shadow-layers 12", "--shadow-slices 17", "--shadow-nodes 3",
          "--shadow-nodes 17", "--layer-growth 0.5", "--layer-ends late"})
        EXPECT_EQ(run(std::string("render hair.hairloom -o x.png ") + wrong).exitCode, 2) << wrong;
}

TEST_F(RenderJob, LooksAreAppliedByNameByOptionsAndViews) {
    const auto drawn = [&](const std::string& way) {
        runJson("render hair.hairloom -o hair.png --size 96x96 --passes 1 --engine software " + way);
        return readText(folder / "hair.png");
    };
    std::set<std::string> names;
    const auto listed = runJson("set --list");
    for (const auto& look : listed["looks"]) names.insert(look["look"]);
    EXPECT_GE(names.size(), 17u);
    std::set<std::string> pictures;
    for (const std::string& name : names) {
        const std::string picture = drawn("--look '" + name + "'");
        pictures.insert(picture);
        EXPECT_EQ(drawn(view("look.json", R"({"look": ")" + name + "\"}")), picture) << name;
        runJson("set hair.hairloom --look '" + name + "' -o other.hairloom");
        runJson("render other.hairloom -o hair.png --size 96x96 --passes 1 --engine software");
        EXPECT_EQ(readText(folder / "hair.png"), picture) << name;
    }
    EXPECT_EQ(pictures.size(), names.size());
    EXPECT_EQ(drawn(view("look.json", R"({"look": "neon"})") + " --look brown"), drawn("--look brown"));
    const auto unknown = run("render hair.hairloom -o x.png" + view("look.json", R"({"look": "moon"})"));
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.errors, HasSubstr("look.json"));
    EXPECT_THAT(unknown.errors, HasSubstr("auburn"));
    EXPECT_EQ(run("render hair.hairloom -o x.png --look moon").exitCode, 2);
    EXPECT_EQ(run("set hair.hairloom -o x.hairloom --look moon").exitCode, 2);
    // Fields go before it, and a natural look keeps the controls that there are.
    const auto material = [&](const std::string& how) {
        runJson("set hair.hairloom -o other.hairloom " + how);
        const std::string text = readText(folder / "other.hairloom");
        return text;
    };
    EXPECT_THAT(material("--look glints material.glintIntensity=7"), HasSubstr("\"glintIntensity\": 7"));
    EXPECT_THAT(material("--look glints"), HasSubstr("\"shadingModel\": \"sadeghi\""));
}

TEST_F(RenderJob, TheSoftwareRendererDrawsWhereThereIsNoGpu) {
    const auto asked = picture("--engine software");
    EXPECT_EQ(asked["device"], "software renderer");
    EXPECT_FALSE(asked.contains("notes"));
    const std::string drawn = readText(folder / "hair.png");
    const auto moving = picture("--engine software --motion nod --frame 3");
    EXPECT_EQ(moving["engine"], "cpu");
    EXPECT_NE(drawn, readText(folder / "hair.png"));
    for (const char* const wrong :
         {"--engine software --device 0", "--engine software --backend vulkan", "--engine fast"}) {
        EXPECT_EQ(run(std::string("render hair.hairloom -o x.png ") + wrong).exitCode, 2) << wrong;
    }
    const auto strips = run("render hair.hairloom -o x.png --engine software --ribbons strip");
    EXPECT_EQ(strips.exitCode, 1);
    EXPECT_THAT(strips.errors, HasSubstr("software renderer"));
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

#ifndef _WIN32
TEST_F(RenderJob, ItDrawsWithoutADriverAndSaysSo) {
    const char* const names[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    std::vector<std::optional<std::string>> before;
    for (const char* const name : names) {
        const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
        before.push_back(value == nullptr ? std::nullopt : std::optional<std::string>(value));
        setenv(name, "/nonexistent.json", 1);  // NOLINT(concurrency-mt-unsafe)
    }
    const auto drawn = picture("");
    const auto strips = run("render hair.hairloom -o x.png --ribbons strip");
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i]) {
            setenv(names[i], before[i]->c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
        } else {
            unsetenv(names[i]);  // NOLINT(concurrency-mt-unsafe)
        }
    }
    EXPECT_EQ(drawn["device"], "software renderer");
    ASSERT_EQ(drawn["notes"].size(), 1);
    EXPECT_THAT(drawn["notes"][0].get<std::string>(), HasSubstr("software renderer draws"));
    EXPECT_EQ(strips.exitCode, 1);
}
#endif

TEST_F(RenderJob, BrokenViewsAreErrorsThatNameThem) {
    const auto refuses = [&](const std::string& content, const std::string& part) {
        const Outcome outcome = run("render hair.hairloom -o none.png" + view("bad.json", content));
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_THAT(outcome.errors, testing::AllOf(HasSubstr("bad.json"), HasSubstr(part)));
        EXPECT_FALSE(std::filesystem::exists(folder / "none.png"));
    };
    refuses(R"({"lights": [{"type": "candle"}]})", "candle");
    refuses(R"({"lights": [{"type": "point", "position": [0, 1, 0]}]})", "intensity");
    refuses(R"({"lights": [{"type": "environment", "sky": [1, 1, 1]}]})", "ground");
    refuses(R"({"shadow_resolution": 63})", "shadow_resolution");
    refuses(R"({"shadow_filter": "7x7"})", "shadow_filter");
    refuses(R"({"subdivisions": 1.5})", "subdivisions");
    const Outcome missing =
        run("render hair.hairloom -o none.png" +
            view("lost.json", R"({"lights": [{"type": "environment", "image": "no.png"}]})"));
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_THAT(missing.errors, HasSubstr("no.png"));
}

TEST_F(RenderJob, SequencesAreNumberedAndJoined) {
    const auto report = picture("--turntable 3 --animation turn.png --strip strip.png --exr hair.exr");
    EXPECT_EQ(report["pictures"], 3);
    std::set<std::string> pictures;
    for (const char* number : {"0000", "0001", "0002"}) {
        pictures.insert(readText(folder / (std::string("hair_") + number + ".png")));
        EXPECT_EQ(readText(folder / (std::string("hair_") + number + ".exr")).substr(0, 4),
                  "\x76\x2f\x31\x01");
    }
    EXPECT_EQ(pictures.size(), 3u);
    EXPECT_THAT(readText(folder / "turn.png"), HasSubstr("acTL"));
    EXPECT_TRUE(std::filesystem::exists(folder / "strip.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "hair.png"));

    runJson("simulate hair.hairloom --frames 4 --wind 3,0,0 --record wind.frames");
    const auto wind = picture("--record wind.frames --frames 0,3,3");
    EXPECT_EQ(wind["pictures"], 2);
    EXPECT_NE(readText(folder / "hair_0000.png"), readText(folder / "hair_0001.png"));
    EXPECT_EQ(run("render hair.hairloom -o x.png --record wind.frames --frames 3,0").exitCode, 2);
}

TEST_F(RenderJob, HairIsSimulatedWhileItIsDrawnOnEitherEngine) {
    const auto cpu = picture("--motion nod --wind 3,0,0 --frame 6 --engine cpu");
    EXPECT_EQ(cpu["engine"], "cpu");
    EXPECT_EQ(cpu["why"], "you asked for it");
    const std::string onCpu = readText(folder / "hair.png");
    const auto gpu = picture("--motion nod --wind 3,0,0 --frames 0,6,6 --engine gpu");
    EXPECT_EQ(gpu["engine"], "gpu");
    EXPECT_EQ(gpu["pictures"], 2);
    EXPECT_NE(readText(folder / "hair_0000.png"), readText(folder / "hair_0001.png"));
    EXPECT_NE(onCpu, readText(folder / "hair_0000.png"));
    const auto still = picture("--engine gpu"), calm = picture("--engine cpu");  // nothing moves
    EXPECT_EQ(still["engine"], "gpu");
    EXPECT_EQ(still["why"], "you asked for it");
    EXPECT_EQ(calm["engine"], picture("")["engine"]) << "nothing is simulated";
    EXPECT_NE(calm["why"], "you asked for it");
    EXPECT_EQ(run("render hair.hairloom -o x.png --frames 0,3").exitCode, 2);

    const auto joined = runJson(
        "render hair.hairloom -o joined.png --size 48x48 --aa none --motion nod --frame 4 --engine cpu "
        "--temporal");
    EXPECT_TRUE(targets(joined).contains("history"));
    EXPECT_EQ(run("render hair.hairloom -o x.png --motion nod --frame 4 --temporal --passes 4").exitCode, 2);
    const auto simulated = runJson("simulate hair.hairloom --frames 2 --engine gpu");
    EXPECT_EQ(simulated["engine"], "gpu");
    EXPECT_FALSE(simulated["device"].is_null());
    const auto automatic = runJson("simulate hair.hairloom --frames 2 --engine auto --method lattice");
    EXPECT_EQ(automatic["engine"], "cpu");
    EXPECT_THAT(automatic["why"].get<std::string>(), HasSubstr("strand engine"));
}

TEST_F(RenderJob, LayersOfAPictureAreInItsExr) {
    const auto channels = [&](const std::string& name) {
        const std::string text = readText(folder / name);
        return text.substr(0, text.find("compression"));
    };
    picture("--exr hair.exr");
    EXPECT_THAT(channels("hair.exr"), Not(HasSubstr("depth.Z")));
    const auto report = picture("--exr hair.exr --aov depth,id,velocity,albedo");
    for (const char* name : {"depth.Z", "id.X", "velocity.X", "velocity.Y", "albedo.B"})
        EXPECT_THAT(channels("hair.exr"), HasSubstr(name));
    EXPECT_TRUE(targets(report).contains("surface"));
    EXPECT_EQ(run("render hair.hairloom -o x.png --aov depth").exitCode, 2) << "no EXR";
    EXPECT_EQ(run("render hair.hairloom -o x.png --exr x.exr --aov light").exitCode, 2);

    // Hair in wind moves in a record as in a simulation, and other places give other layers.
    runJson("simulate hair.hairloom --frames 4 --wind 3,0,0 --record wind.frames");
    picture("--record wind.frames --frame 0 --exr still.exr --aov velocity --device 0");
    picture("--record wind.frames --frame 3 --exr moving.exr --aov velocity");
    picture("--motion none --wind 3,0,0 --engine gpu --frame 4 --exr live.exr --aov velocity");
    EXPECT_NE(readText(folder / "still.exr"), readText(folder / "moving.exr"));
    EXPECT_GT(std::filesystem::file_size(folder / "live.exr"),
              std::filesystem::file_size(folder / "still.exr"));
}

TEST_F(RenderJob, BenchPlaysAsTheEditorDoes) {
    const auto report =
        runJson("bench live --grooms hair.hairloom --size 64x36 --frames 2 --markdown live.md");
    ASSERT_EQ(report["rows"].size(), 2u);
    for (const auto& row : report["rows"]) {
        for (const char* name :
             {"simulate_ms", "follow_ms", "shadow_ms", "shade_ms", "draw_ms", "frame_ms", "wall_ms"})
            EXPECT_GE(row[name].get<double>(), 0) << name;
        EXPECT_GT(row["hairs"].get<int>(), 0);
        EXPECT_GT(row["bytes_to_device"].get<double>(), 0);
    }
    EXPECT_EQ(report["rows"][0]["engine"], "gpu");
    EXPECT_LT(report["rows"][0]["bytes_from_device"].get<double>(), 64'000);
    EXPECT_EQ(report["rows"][1]["engine"], "cpu");
    EXPECT_THAT(readText(folder / "live.md"), HasSubstr("| hair.hairloom | gpu |"));
}

TEST_F(RenderJob, BenchMeasuresEachPass) {
    // Some rows of many: on an empty cache of shaders each compiles for seconds.
    const auto report = runJson(
        "bench render --grooms hair.hairloom --hairs 40 --size 32x32 --repeat 2 --markdown table.md "
        "--only 'hair.hairloom,40 hairs,FXAA,weighted,shadows: none'");
    std::set<std::string> names;
    EXPECT_EQ(report["rows"][0]["name"], "hair.hairloom");
    EXPECT_GT(report["rows"][0]["hairs"], 0);
    for (const auto& row : report["rows"]) {
        names.insert(row["name"]);
        EXPECT_EQ(row["n"], 2);
        EXPECT_LE(row["min"], row["median"]);
    }
    for (const char* name :
         {"40 hairs", "40 hairs, wall", "40 hairs, opacity layers", "anti-aliasing: FXAA, filter",
          "transparency: weighted, blend", "40 hairs, software renderer"}) {
        EXPECT_TRUE(names.contains(name)) << name;
    }
    EXPECT_THAT(readText(folder / "table.md"), HasSubstr("| shadows: none |"));
    EXPECT_FALSE(names.contains("ribbons: strip")) << "was not asked for";
    const auto none = run("bench render --grooms hair.hairloom --only nothing,alike");
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.errors, HasSubstr("no row has 'nothing' or 'alike' in its name"));
}

}  // namespace
}  // namespace hairloom::test
