// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail by the command line, as docs/cli.md promises them.

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class LodJob : public CommandLineTest {
  protected:
    void makeHair() {
        runJson("create --mesh '" + bustFile() +
                "' --scalp material:scalp --count 400 --placement dart --length 0.15 --points 10 --seed 3 -o "
                "hair.hairloom");
    }
};

TEST_F(LodJob, MakesAndMeasuresAChainThatIsTheSameForAnyThreads) {
    makeHair();
    const std::string arguments =
        "lod hair.hairloom --levels strands:0.5@64,cards:24@64,shell:300@32 --directions 2 -o ";
    const auto report = runJson(arguments + "one --threads 1");
    ASSERT_EQ(report["levels"].size(), 3u);
    for (const auto& level : report["levels"]) {
        for (const char* key : {"name",          "kind",
                                "hairs",         "cards",
                                "triangles",     "bytes",
                                "distance_m",    "coverage",
                                "flip",          "light",
                                "silhouette_px", "ms_draw",
                                "ms_move",       "largest_patch_cm2",
                                "hairline_mm",   "rim",
                                "scaliness",     "motion_px",
                                "holes",         "fails"})
            EXPECT_TRUE(level.contains(key)) << key;
        EXPECT_GT(level["triangles"], 0);
        // At the distances of all levels, from its own on.
        const std::size_t count = level["distance_m"] == report["levels"][0]["distance_m"] ? 2 : 1;
        ASSERT_EQ(level["flips"].size(), count);
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_EQ(level["flips"][i]["distance_m"],
                      report["levels"][0]["flips"][2 - count + i]["distance_m"]);
        EXPECT_EQ(level["flips"][0]["distance_m"], level["distance_m"]);
        EXPECT_GT(level["flips"][0]["flip"], 0);
        EXPECT_NEAR(level["coverage"].get<double>(), 1, 0.05) << "thin hair as well";
    }
    // What one sees who walks away from level to level: of 400 hairs more than the 2 % of full heads.
    double before = 0, largest = 0;
    for (const auto& level : report["levels"]) {
        for (const auto& at : level["lights"]) {
            const double light = at["light"];
            if (before > 0) largest = std::max(largest, std::abs(light / before - 1));
            before = light;
        }
    }
    EXPECT_LT(largest, 0.1);
    EXPECT_NEAR(report["largest_light_step"].get<double>(), largest, 1e-9);
    EXPECT_EQ(report["levels"][1]["lights"].size(), 3u) << "at 64, 48 and 32 pixels of head height";
    EXPECT_EQ(report["springs"]["motion"], "nod");
    EXPECT_LT(report["springs"]["error_mm"], report["springs"]["default_error_mm"]);
    EXPECT_LT(report["springs"]["settling_mm"], 1) << "joints stay where they are at rest";
    EXPECT_EQ(report["levels"][0]["kind"], "strands");
    EXPECT_EQ(report["levels"][0]["hairs"], 200);
    EXPECT_LE(report["levels"][1]["cards"], 24);
    for (const auto& name : report["files"])
        EXPECT_TRUE(fs::exists(folder / "one" / name.get<std::string>())) << name;
    runJson(arguments + "three --threads 3");
    for (const char* name : {"levels.glb", "cards-24.png", "cards-24_colour.png", "cards-24_colour.1.png"}) {
        EXPECT_EQ(readText(folder / "one" / name), readText(folder / "three" / name)) << name;
    }
}

TEST_F(LodJob, CardsAreShapedByHandThroughTheScriptThatItWrites) {
    makeHair();
    const std::string levels = " --levels cards:12@32 --directions 1 -o ";
    EXPECT_EQ(runJson("lod hair.hairloom" + levels + "before")["lost_card_edits"], 0);
    auto script = nlohmann::json::parse(readText(folder / "before" / "cards-12.json"));
    auto& edits = script["operations"][0]["card_edits"];
    ASSERT_LE(edits.size(), 12u);
    std::size_t roots = 0;
    for (const auto& edit : edits) roots += edit["roots"].size();
    EXPECT_EQ(roots, 3u * 400u) << "each hair is of one card";
    const std::size_t cards = edits.size();
    while (edits.size() > 2) edits.erase(edits.size() - 1);
    edits[0]["deleted"] = true, edits[1]["width"] = 2;
    const auto held = edits[1]["roots"];
    std::ofstream(folder / "hand.json") << script.dump();
    runJson("groom hair.hairloom --script hand.json -o shaped.hairloom");
    const auto after = runJson("lod shaped.hairloom" + levels + "after");
    EXPECT_EQ(after["levels"][0]["cards"], cards - 1);
    script = nlohmann::json::parse(readText(folder / "after" / "cards-12.json"));
    bool isThere = false;
    for (const auto& edit : script["operations"][0]["card_edits"])
        isThere = isThere || (edit["roots"] == held && edit["width"] == 2);
    EXPECT_TRUE(isThere);
    // Another number of cards is another level.
    EXPECT_EQ(runJson("lod shaped.hairloom --levels cards:8@32 --directions 1 -o eight")["unmade_card_edits"],
              2);
    script["operations"][0]["card_edits"][0]["level"] = 0;
    std::ofstream(folder / "hand.json") << script.dump();
    EXPECT_THAT(run("groom hair.hairloom --script hand.json -o bad.hairloom").errors,
                HasSubstr("level is 0"));
    EXPECT_FALSE(fs::exists(folder / "bad.hairloom"));
}

TEST_F(LodJob, SaysWhatCannotBe) {
    makeHair();
    const auto spec = run("lod hair.hairloom -o out --levels braids:3");
    EXPECT_EQ(spec.exitCode, 2) << "wrong usage";
    EXPECT_THAT(spec.errors, HasSubstr("unknown kind"));
    const auto target = run("lod hair.hairloom -o out --levels cards:2@256 --directions 1 --target-px 0.01");
    EXPECT_EQ(target.exitCode, 1);
    EXPECT_THAT(target.errors, HasSubstr("more than the 0.01 asked for"));
    EXPECT_FALSE(fs::exists(folder / "out")) << "nothing is left of what failed";
    runJson(
        "create --mesh '" + bustFile() +
        "' --scalp material:scalp --count 1 --placement random --length 0.15 --points 10 -o one.hairloom");
    EXPECT_THAT(run("lod one.hairloom -o out").errors, HasSubstr("one strand; at least two"));
}

TEST_F(LodJob, CardsAreExportedAsGltf) {
    makeHair();
    const auto report =
        runJson("export hair.hairloom --format gltf --levels cards:12@64,shell:200@32 -o hair.glb");
    EXPECT_EQ(report["strands"], 400);
    EXPECT_EQ(report["levels"].size(), 2u);
    EXPECT_EQ(report["bytes"], fs::file_size(folder / "hair.glb"));
    EXPECT_TRUE(fs::exists(folder / "hair.glb.report.json"));
    const auto read = runJson("info hair.glb");
    EXPECT_GT(read["scalp"]["vertices"], 20) << "our own reader takes it for a mesh";
    EXPECT_TRUE(report["max_error_mm"].is_null()) << "no point of a strand is in the file";
    EXPECT_THAT(run("export hair.hairloom --format gltf --up z -o z.glb").errors, HasSubstr("metres, Y up"));
    EXPECT_FALSE(fs::exists(folder / "z.glb"));
    const auto few =
        runJson("export hair.hairloom --target cards --cards 8 --segments 1 --from-px 64 -o few.glb");
    EXPECT_EQ(few["format"], "gltf");
    ASSERT_EQ(few["levels"].size(), 4u);
    EXPECT_LE(few["levels"][0]["cards"], 8);
    constexpr int kOfCap = 600;  // squares of 3 cm, those of six directions overlapping
    EXPECT_LE(few["levels"][0]["triangles"], 8 * 4 + kOfCap)
        << "one segment of at most two quads a card, and the cap";
    EXPECT_NEAR(few["levels"][0]["distance_m"], 5.8, 0.01);
}

TEST_F(LodJob, UsdHasLevelsOfStrandsBesideCards) {
    makeHair();
    const auto report = runJson(
        "export hair.hairloom --format usda-cards --levels strands:1@256,strands:0.25@128,cards:12@64 -o "
        "l.usda");
    ASSERT_EQ(report["levels"].size(), 3u);
    EXPECT_EQ(report["levels"][0]["cards"], 0);
    EXPECT_NEAR(report["levels"][0]["coverage"], 1, 0.02) << "all strands, beside themselves";
    EXPECT_LT(report["levels"][1]["triangles"], report["levels"][0]["triangles"]);
    EXPECT_GT(report["levels"][2]["cards"], 0);
    EXPECT_LT(report["levels"][1]["distance_m"], report["levels"][2]["distance_m"]);
    const std::string text = readText(folder / "l.usda");
    for (const char* part : {"LODRootAPI", "LODDistanceHeuristic", "def BasisCurves", "def Mesh", "\"LOD2\""})
        EXPECT_THAT(text, HasSubstr(part));
    // Programs that do not know UsdLod see one level, and so do we.
    EXPECT_EQ(runJson("import l.usda -o back.hairloom")["strands"], 400);
    EXPECT_EQ(
        runJson("export hair.hairloom --format usda-cards --levels cards:12@64 -o c.usda")["levels"].size(),
        1u);
}

TEST_F(LodJob, SpringsAreFittedForTheRateOfTheEngine) {
    makeHair();
    const std::string levels = "export hair.hairloom --levels cards:12@64 --format ";
    const auto errorAt = [](const nlohmann::json& report, double hz) {
        for (const auto& rate : report["springs"]["rates"])
            if (rate["hz"] == hz) return rate["error_mm"].get<double>();
        return -1.0;
    };
    const auto plain = runJson(levels + "gltf -o plain.glb");
    const auto slow = runJson(levels + "gltf --spring-hz 30 -o slow.glb");
    EXPECT_EQ(plain["springs"]["hz"], 60);
    EXPECT_EQ(slow["springs"]["hz"], 30);
    ASSERT_EQ(slow["springs"]["rates"].size(), 4u) << "30, 60, 120 and 144";
    EXPECT_LT(errorAt(slow, 30), errorAt(plain, 30));
    EXPECT_LT(errorAt(plain, 60), errorAt(slow, 60));
    EXPECT_GT(errorAt(plain, 144), errorAt(plain, 60)) << "other rates cost";
    const auto odd = runJson(levels + "vrm --spring-hz 72.5 -o odd.vrm");
    EXPECT_EQ(odd["springs"]["rates"].size(), 5u);
    EXPECT_GE(errorAt(odd, 72.5), 0);
    for (const auto& [name, hz] : {std::pair("plain.glb", 60.0), {"slow.glb", 30.0}, {"odd.vrm", 72.5}}) {
        const std::string file = readText(folder / name);
        std::uint32_t bytes = 0;
        std::memcpy(&bytes, file.data() + 12, 4);
        EXPECT_EQ(nlohmann::json::parse(file.substr(20, bytes))["extras"]["spring_hz"], hz) << name;
    }
    EXPECT_FALSE(runJson(levels + "obj-cards --spring-hz 30 -o hair.obj").contains("springs"))
        << "it has none";
    EXPECT_EQ(run(levels + "gltf --spring-hz 0 -o bad.glb").exitCode, 2);
}

TEST_F(LodJob, SpheresOfTheFileAreOnTheBonesOfTheCharacter) {
    makeHair();
    std::ofstream(folder / "spheres.json")
        << R"([{"name": "skull", "centre": [0, 1.69, -0.01], "radius": 0.078, "bone": "head"},
               {"name": "chest", "centre": [0, 1.4, 0], "radius": 0.1, "bone": "root"},
               {"name": "lost", "centre": [0, 1.3, 0], "radius": 0.05, "bone": "tail"}])";
    runJson("spheres hair.hairloom --from spheres.json --replace -o hair.hairloom --force");
    const auto done = run("export hair.hairloom --format gltf --levels cards:12@64 -o hair.glb");
    EXPECT_EQ(done.exitCode, 0) << done.errors;
    EXPECT_THAT(done.errors, HasSubstr("the character has no bone 'tail'"));
    const std::string file = readText(folder / "hair.glb");
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, file.data() + 12, 4);
    const auto json = nlohmann::json::parse(file.substr(20, bytes));
    const auto& colliders = json["extensions"]["VRMC_springBone"]["colliders"];
    ASSERT_EQ(colliders.size(), 3u);
    const char* const bones[] = {"head", "root", "hair"};
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(json["nodes"][colliders[c]["node"].get<std::size_t>()]["name"], bones[c]);
}

TEST_F(LodJob, CardsAreExportedAsAnAvatar) {
    makeHair();
    const auto report = runJson("export hair.hairloom --target avatar --levels cards:12@64 -o curly.vrm");
    EXPECT_EQ(report["format"], "vrm");
    std::string said;
    for (const auto& finding : report["findings"]) said += finding["what"].get<std::string>() + "\n";
    EXPECT_THAT(said, HasSubstr("no whole humanoid"));
    EXPECT_THAT(said, HasSubstr("author and licence"));
    const std::string file = readText(folder / "curly.vrm");
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, file.data() + 12, 4);
    const auto json = nlohmann::json::parse(file.substr(20, bytes));
    EXPECT_THAT(json["extensionsUsed"], testing::Contains("VRMC_vrm"));
    const auto& vrm = json["extensions"]["VRMC_vrm"];
    EXPECT_EQ(vrm["specVersion"], "1.0");
    EXPECT_EQ(vrm["meta"]["name"], "curly");
    EXPECT_FALSE(vrm["meta"]["authors"].empty());
    const auto& bones = vrm["humanoid"]["humanBones"];
    ASSERT_EQ(bones.size(), 15u);
    std::vector<int> parent(json["nodes"].size(), -1);
    for (std::size_t n = 0; n < parent.size(); ++n)
        if (json["nodes"][n].contains("children"))
            for (const auto& child : json["nodes"][n]["children"])
                parent[child.get<std::size_t>()] = static_cast<int>(n);
    const auto isBelow = [&](const char* bone, const char* above) {
        for (int n = parent[bones[bone]["node"].get<std::size_t>()]; n >= 0;
             n = parent[static_cast<std::size_t>(n)])
            if (bones[above]["node"] == n) return true;
        return false;
    };
    const std::pair<const char*, const char*> kPairs[] = {{"spine", "hips"},
                                                          {"head", "spine"},
                                                          {"leftFoot", "leftLowerLeg"},
                                                          {"leftLowerLeg", "leftUpperLeg"},
                                                          {"leftUpperLeg", "hips"},
                                                          {"rightHand", "rightLowerArm"},
                                                          {"rightUpperArm", "spine"}};
    for (const auto& [bone, above] : kPairs) EXPECT_TRUE(isBelow(bone, above)) << bone;
    EXPECT_EQ(json["nodes"][bones["head"]["node"].get<std::size_t>()]["name"], "head") << "the file's own";
    EXPECT_FALSE(json["extensions"]["VRMC_springBone"]["springs"].empty());
}

TEST_F(LodJob, CardsAreExportedForProgramsThatReadNoGltf) {
    makeHair();
    const std::string levels = " --levels cards:12@64,shell:200@32 -o ";
    const auto fbx = runJson("export hair.hairloom --format fbx" + levels + "hair.fbx");
    EXPECT_EQ(fbx["format"], "fbx");
    EXPECT_EQ(fbx["companions"], (nlohmann::json{"hair_cards-12_colour.png", "hair_cards-12_normal.png"}));
    for (const auto& name : fbx["companions"]) EXPECT_TRUE(fs::exists(folder / name.get<std::string>()));
    // Our own reader, another one's of FBX: centimetres became metres, and the meshes are there.
    const auto read = runJson("info hair.fbx");
    EXPECT_EQ(read["scalp"]["triangles"].get<int>(),
              fbx["levels"][0]["triangles"].get<int>() + fbx["levels"][1]["triangles"].get<int>())
        << "none is of no area, none is there twice: the reader would drop them";
    EXPECT_NEAR(read["bounds"]["max"][1].get<double>(), 1.9, 0.4) << "metres";
    fs::create_directory(folder / "again");
    runJson("export hair.hairloom --format fbx" + levels + "again/hair.fbx");
    EXPECT_EQ(readText(folder / "again" / "hair.fbx"), readText(folder / "hair.fbx")) << "the same bytes";
    const auto obj = runJson("export hair.hairloom --target cards-obj" + levels + "hair.obj");
    EXPECT_EQ(obj["companions"][0], "hair.mtl");
    EXPECT_THAT(readText(folder / "hair.obj"), HasSubstr("mtllib hair.mtl"));
    EXPECT_THAT(readText(folder / "hair.mtl"), HasSubstr("hair_cards-12_colour.png"));
    // As strips of polygons it opens as ribbons of hair, so its faces are counted here.
    int triangles = 0;
    std::istringstream lines(readText(folder / "hair.obj"));
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("f ")) continue;
        std::istringstream words(line);
        int corners = -1;  // but the "f"
        for (std::string word; words >> word;) ++corners;
        triangles += corners - 2;
    }
    EXPECT_EQ(triangles, read["scalp"]["triangles"].get<int>());
    const auto usd = runJson("export hair.hairloom --target cards-usd" + levels + "hair.usda");
    EXPECT_EQ(usd["companions"], fbx["companions"]);
    const std::string text = readText(folder / "hair.usda");
    EXPECT_EQ(usd["bytes"], text.size());
    for (const char* part :
         {"#usda 1.0", "variantSet \"lod\"", "\"LOD1\"", "\"LODRootAPI\"", "\"UsdLod\" {",
          "def LODDistanceHeuristic \"distance\"", "thresholds = [", "def Mesh \"cards_12\"",
          "def Mesh \"shell_200\"", "@./hair_cards-12_colour.png@", "primvars:st"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    EXPECT_GT(runJson("export hair.hairloom --format gltf" + levels + "hair.glb")["bytes"],
              runJson("export hair.hairloom --format gltf-quantised" + levels + "small.glb")["bytes"]);
}

}  // namespace
}  // namespace hairloom::test
