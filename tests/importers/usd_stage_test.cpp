// SPDX-License-Identifier: GPL-3.0-or-later
// What USD stages show: composition, visibility, instances, times and names.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/file.h"
#include "importers/strands.h"
#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHead = "#usda 1.0\n(\n    defaultPrim = \"groom\"\n    metersPerUnit = 1\n)\n";

/// `strands` lines of two points from (x, 0, 0) upwards.
std::string curves(const std::string& name, int strands, double x = 0, const std::string& more = {},
                   const std::string& metadata = {}) {
    std::string counts, points;
    for (int s = 0; s < strands; ++s) {
        counts += (s > 0 ? ", 2" : "2");
        points += (s > 0 ? ", (" : "(") + std::to_string(x + 0.01 * s) + ", 0, 0), (" +
                  std::to_string(x + 0.01 * s) + ", 0.1, 0)";
    }
    return "def BasisCurves \"" + name + "\" (" + metadata +
           ")\n{\n    uniform token type = \"linear\"\n    int[] " + "curveVertexCounts = [" + counts +
           "]\n    point3f[] points = [" + points + "]\n" + more + "\n}\n";
}

class UsdStages : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(folder / "in" / "deep"); }

    void write(const fs::path& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    Result<ImportedStrands> read(const fs::path& name, const StrandImportOptions& options = {}) const {
        return importStrands(folder / name, options);
    }
    Result<ImportedStrands> readText(const std::string& text, const StrandImportOptions& options = {}) const {
        write("stage.usda", text);
        return read("stage.usda", options);
    }
    static std::string said(const ImportedStrands& imported) {
        std::string all;
        for (const Finding& finding : imported.warnings)
            all += finding.where + ": " + finding.what + "; " + finding.fix + "\n";
        return all;
    }
    static std::vector<std::string> layers(const ImportedStrands& imported) {
        std::vector<std::string> names;
        for (const Layer& layer : imported.groom.layers) names.push_back(layer.name);
        return names;
    }
    const TemporaryFolder folder;
};

TEST_F(UsdStages, EscapesInTextsAreTheirCharacters) {
    const auto imported = readText(kHead + curves("a", 1, 0, "", R"(displayName = "\x48air\40\"\\\"\x2e")") +
                                   curves("b", 1, 1, "", R"(displayName = '\'B\303\244rte\q')"));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_THAT(layers(*imported), ElementsAre("Hair \"\\\".", "'B\xc3\xa4rteq"));
}

TEST_F(UsdStages, WhatIsNotShownStaysOutAndIsTold) {
    const auto imported = readText(
        kHead + curves("shown", 3) + curves("off", 2, 1, "", "active = false") +
        "def Xform \"old\"\n{\n    token visibility = \"invisible\"\n" + curves("hair", 4, 2) + "}\n" +
        "class Xform \"proto\"\n{\n" + curves("hair", 5, 3) + "}\n" + "over \"nowhere\"\n{\n" +
        curves("hair", 6, 4) + "}\n" + curves("quick", 7, 5, "    uniform token purpose = \"proxy\""));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strandCount(), 3u);
    for (const char* word : {"/off is not active", "/old is not visible", "/proto is a class"})
        EXPECT_THAT(said(*imported), HasSubstr(word));
    const auto none = readText(kHead + curves("off", 2, 1, "", "active = false"));
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), HasSubstr("/off is not active")) << "the reason is in the error";
}

TEST_F(UsdStages, CurvesWhosePurposeIsToGuideAreGuides) {
    const auto imported =
        readText(kHead + curves("hair", 3) + curves("guides", 2, 1, "    uniform token purpose = \"guide\""));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_THAT(imported->groom.strandAttributes.view<std::uint8_t>(attribute::kGuide),
                ElementsAre(0, 0, 0, 1, 1));
    EXPECT_THAT(layers(*imported), ElementsAre("hair", "guides"));
}

TEST_F(UsdStages, ReferencesPayloadsAndLayersOfTheFolderAreFollowed) {
    write("in/geo.usda", kHead + std::string("def Xform \"groom\"\n{\n") + curves("hair", 3) +
                             curves("brows", 2, 1) + "}\n");
    write("in/deep/mid.usda", std::string("#usda 1.0\n(\n defaultPrim = \"m\"\n)\n") +
                                  "def \"m\" (prepend payload = @../geo.usda@</groom/brows>)\n{\n}\n");
    write("stage.usda", kHead +
                            std::string("def Xform \"groom\" (prepend references = @./in/geo.usda@)\n{\n") +
                            "    over \"hair\" (active = false)\n    {\n    }\n}\n" +
                            "def \"other\" (payload = @in/deep/mid.usda@)\n{\n" +
                            "    double3 xformOp:translate = (0, 5, 0)\n" +
                            "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n");
    const auto imported = read("stage.usda");
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 4u) << said(*imported);
    EXPECT_FLOAT_EQ(imported->groom.strand(2)[0].y(), 5);
    EXPECT_THAT(layers(*imported), ElementsAre("brows", "other"));
    write("layers.usda",
          std::string("#usda 1.0\n(\n    metersPerUnit = 1\n    subLayers = [@in/geo.usda@]\n)\n") +
              "over \"groom\"\n{\n    over \"brows\"\n    {\n" +
              "        point3f[] points = [(0, 1, 0), (0, 2, 0), (1, 1, 0), (1, 2, 0)]\n    }\n}\n");
    const auto layered = read("layers.usda");
    ASSERT_TRUE(layered) << layered.error().message();
    ASSERT_EQ(layered->groom.strandCount(), 5u);
    EXPECT_FLOAT_EQ(layered->groom.strand(4)[1].y(), 2) << "the stronger layer's points";
}

TEST_F(UsdStages, FilesElsewhereAreNotReadWhateverLeadsThere) {
    write("secret.usda", kHead + std::string("def Xform \"groom\"\n{\n") + curves("hair", 3) + "}\n");
    std::vector<std::string> assets{"../secret.usda", (folder / "secret.usda").generic_string()};
    std::error_code code;
    fs::create_symlink(folder / "secret.usda", folder / "in" / "link.usda", code);
    if (!code) assets.emplace_back("./link.usda");
    for (const std::string& asset : assets) {
        write("in/stage.usda",
              kHead + curves("own", 1, 1) + "def \"groom\" (references = @" + asset + "@)\n{\n}\n");
        const auto imported = read("in/stage.usda");
        ASSERT_TRUE(imported) << imported.error().message();
        EXPECT_EQ(imported->groom.strandCount(), 1u) << asset;
        EXPECT_THAT(said(*imported), HasSubstr("outside the folder")) << asset;
    }
    write("in/stage.usda", kHead + std::string("def \"groom\" (payload = @missing.usda@)\n{\n}\n"));
    EXPECT_THAT(read("in/stage.usda").error().message(),
                HasSubstr("payload \"missing.usda\" of /groom: there is no"));
    const auto bytes = readFile(folder / "in/stage.usda").value();
    EXPECT_THAT(importStrandsFromMemory("memory", bytes).error().message(),
                HasSubstr("other files are not read"));
}

TEST_F(UsdStages, StagesThatLeadToThemselvesEnd) {
    write("stage.usda",
          kHead + curves("hair", 1) + "def \"a\" (references = @stage.usda@</a>)\n{\n}\n" +
              "def \"b\" (references = </b/c>)\n{\n    def \"c\" (references = </b>)\n    {\n    }\n}\n");
    const auto imported = read("stage.usda");
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strandCount(), 1u);
    EXPECT_THAT(said(*imported), HasSubstr("leads to itself"));
    // Ten times ten times ten …: refused before memory is full.
    std::string laughs = kHead + std::string("def \"p0\"\n{\n") + curves("hair", 1) + "}\n";
    for (int level = 1; level <= 9; ++level) {
        laughs += "def \"p" + std::to_string(level) + "\"\n{\n";
        for (int copy = 0; copy < 10; ++copy)
            laughs += "    def \"c" + std::to_string(copy) + "\" (references = </p" +
                      std::to_string(level - 1) + ">)\n    {\n    }\n";
        laughs += "}\n";
    }
    const auto refused = readText(laughs);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("more"));
}

TEST_F(UsdStages, TheSelectedVariantComesInAndIsTold) {
    const std::string sets = "    variantSet \"lod\" = {\n        \"low\" {\n" + curves("hair", 2) +
                             "        }\n        \"high\" {\n" + curves("hair", 7) + "        }\n    }\n";
    const auto imported =
        readText(kHead + std::string("def Xform \"groom\" (\n    variants = {\n        string lod = ") +
                 "\"high\"\n    }\n    prepend variantSets = \"lod\"\n)\n{\n" + sets + "}\n");
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strandCount(), 7u);
    EXPECT_THAT(said(*imported), HasSubstr("variant \"high\" of \"lod\" of /groom"));
    const auto none = readText(
        kHead + std::string("def Xform \"groom\" (prepend variantSets = \"lod\")\n{\n") + sets + "}\n");
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), HasSubstr("none is selected"));
}

TEST_F(UsdStages, ClassesAndPrototypesAreShownOnceAnInstance) {
    const std::string move =
        "    double3 xformOp:translate = (0, 1, 0)\n    uniform token[] xformOpOrder = "
        "[\"xformOp:translate\"]\n";
    const auto inherited = readText(kHead + std::string("class Xform \"_c\"\n{\n") + curves("hair", 2) +
                                    "}\n" + "def Xform \"one\" (inherits = </_c>)\n{\n" + move + "}\n" +
                                    "def Xform \"two\" (inherits = </_c>\n    instanceable = true)\n{\n}\n");
    ASSERT_TRUE(inherited) << inherited.error().message();
    ASSERT_EQ(inherited->groom.strandCount(), 4u);
    EXPECT_FLOAT_EQ(inherited->groom.strand(0)[0].y(), 1);
    EXPECT_THAT(layers(*inherited), ElementsAre("one", "two"));
    const auto instanced = readText(
        kHead + std::string("def PointInstancer \"pi\"\n{\n    rel prototypes = [</pi/p0>, </pi/p1>]\n") +
        "    int[] protoIndices = [0, 1, 0]\n    point3f[] positions = [(0, 0, 0), (3, 0, 0), (9, 0, 0)]\n" +
        "    float3[] scales = [(1, 1, 1), (2, 2, 2), (1, 1, 1)]\n    int64[] invisibleIds = [2]\n" +
        curves("p0", 2, 0, "    float[] widths = [0.001] (interpolation = \"constant\")") +
        curves("p1", 1, 0, "    float[] widths = [0.001] (interpolation = \"constant\")") + "}\n");
    ASSERT_TRUE(instanced) << instanced.error().message();
    ASSERT_EQ(instanced->groom.strandCount(), 3u) << "the third instance is not visible";
    EXPECT_LT((instanced->groom.strand(2)[1] - Vec3f(3, 0.2f, 0)).norm(), 1e-6f);
    EXPECT_NEAR(instanced->groom.pointAttributes.view<float>(attribute::kRadius)[5], 0.001f, 1e-8f)
        << "as wide as the scale makes it";
}

TEST_F(UsdStages, InstancesThatAreNotActiveStayOutAsLayersSay) {
    const auto instancer = [](const std::string& metadata, const std::string& ids) {
        return kHead + std::string("def PointInstancer \"pi\" (\n") + metadata +
               ")\n{\n    rel prototypes = </pi/p>\n    int[] protoIndices = [0, 0, 0, 0]\n" +
               "    point3f[] positions = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]\n" + ids +
               curves("p", 1) + "}\n";
    };
    const auto places = [](const Result<ImportedStrands>& imported) {
        std::vector<float> found;
        for (std::uint32_t s = 0; imported && s < imported->groom.strandCount(); ++s)
            found.push_back(imported->groom.strand(s)[0].x());
        return found;
    };
    EXPECT_THAT(places(readText(instancer("    append inactiveIds = [1, 3]\n", ""))), ElementsAre(0, 2))
        << "by their places";
    const std::string ids = "    int64[] ids = [10, 20, 30, 40000000000]\n";
    EXPECT_THAT(places(readText(instancer("    inactiveIds = [20, 40000000000]\n", ids))), ElementsAre(0, 2));
    EXPECT_THAT(places(readText(instancer("    inactiveIds = None\n", ids))), ElementsAre(0, 1, 2, 3));
    // A stronger layer takes one back and adds another.
    write("weak.usda", instancer("    prepend inactiveIds = [10, 20]\n", ids));
    write(
        "strong.usda",
        "#usda 1.0\n(\n    metersPerUnit = 1\n    subLayers = [@./weak.usda@]\n)\nover \"pi\" (\n    delete "
        "inactiveIds = [20]\n    append inactiveIds = [30]\n)\n{\n}\n");
    EXPECT_THAT(places(read("strong.usda")), ElementsAre(1, 3));
    EXPECT_FALSE(readText(instancer("    append inactiveIds = [1, 3\n", "")));
}

TEST_F(UsdStages, WidthsOfPrimvarsGoBeforeThoseOfTheAttribute) {
    const auto imported =
        readText(kHead + curves("hair", 1, 0,
                                "    float[] widths = [1, 1] (interpolation = \"vertex\")\n"
                                "    float[] primvars:widths = [0.002, 0.004] (interpolation = "
                                "\"vertex\")"));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_THAT(imported->groom.pointAttributes.view<float>(attribute::kRadius), ElementsAre(0.001f, 0.002f));
    EXPECT_FALSE(imported->groom.pointAttributes.has("widths"));
}

TEST_F(UsdStages, HermiteCurvesPassThroughTheirPointsAlongTheirTangents) {
    const auto imported =
        readText(kHead + std::string("def HermiteCurves \"hair\"\n{\n    int[] curveVertexCounts = [3]\n") +
                 "    point3f[] points = [(0, 0, 0), (1, 0, 0), (2, 0, 0)]\n" +
                 "    vector3f[] tangents = [(1, 3, 0), (1, -3, 0), (1, 3, 0)]\n" +
                 "    float[] widths = [0.001, 0.002, 0.003] (interpolation = \"vertex\")\n}\n");
    ASSERT_TRUE(imported) << imported.error().message();
    const auto strand = imported->groom.strand(0);
    ASSERT_EQ(strand.size(), 7u);
    EXPECT_LT((strand[3] - Vec3f(1, 0, 0)).norm(), 1e-6f);
    // h10 · 3 + h11 · (−3) at t = 1/3: 3 (4/27 + 2/27).
    EXPECT_NEAR(strand[1].y(), 3 * 6.0f / 27, 1e-6f);
    EXPECT_NEAR(imported->groom.pointAttributes.view<float>(attribute::kRadius)[3], 0.001f, 1e-8f);
}

TEST_F(UsdStages, KnotsThatAreTooFewBecomeUniformAndAreTold) {
    const std::string points = "(0, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 0), (0, 4, 0)";
    const auto nurbs = [&](const std::string& knots) {
        return readText(kHead +
                        std::string("def NurbsCurves \"hair\"\n{\n    int[] curveVertexCounts = [5]\n") +
                        "    int[] order = [4]\n    point3f[] points = [" + points +
                        "]\n    double[] knots = " + knots + "\n}\n");
    };
    const auto uniform = nurbs("[0, 1]");
    ASSERT_TRUE(uniform) << uniform.error().message();
    EXPECT_THAT(said(*uniform), HasSubstr("uniform knots were taken"));
    EXPECT_NEAR(uniform->groom.strand(0)[0].y(), 1, 1e-6f) << "(0 + 4 · 1 + 2) / 6";
    const auto maya = nurbs("[0, 0, 0, 1, 2, 2, 2]");
    ASSERT_TRUE(maya) << maya.error().message();
    EXPECT_NEAR(maya->groom.strand(0)[0].y(), 0, 1e-6f)
        << "without the first and last knot, as Maya has them";
    EXPECT_NEAR(maya->groom.strand(0)[4].y(), 4, 1e-6f);
}

TEST_F(UsdStages, PartsBecomeLayersWithTheirNames) {
    const auto imported = readText(kHead + std::string("def Xform \"groom\"\n{\n") + curves("scalp_hair", 3) +
                                   curves("brows", 2, 1, "", "displayName = \"Brows (left)\"") +
                                   curves("lashes", 1, 2) + "}\n");
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_THAT(layers(*imported), ElementsAre("scalp_hair", "Brows (left)", "lashes"));
    EXPECT_THAT(imported->groom.strandAttributes.view<std::uint32_t>(attribute::kLayer),
                ElementsAre(0, 0, 0, 1, 1, 2));
}

TEST_F(UsdStages, GroupsOfObjectsHaveTheirNumbersAndNames) {
    const std::string blender =
        "def Xform \"fringe\"\n{\n    custom int userProperties:groom_group_id = 3\n"
        "    custom string userProperties:groom_group_name = \"Fringe\"\n" +
        curves("c", 2) + "}\n" +
        curves("back", 1, 1,
               "    int[] primvars:groom_group_id = [7] (interpolation = "
               "\"constant\")");
    const auto imported = readText(kHead + blender);
    ASSERT_TRUE(imported) << imported.error().message();
    const auto groups = imported->groom.strandAttributes.view<std::uint32_t>(attribute::kGroup);
    ASSERT_EQ(groups.size(), 3u);
    EXPECT_EQ(imported->groom.groupNames[groups[0]], "Fringe");
    EXPECT_EQ(imported->groom.groupNames[groups[2]], "group 7");
    EXPECT_THAT(imported->groom.strandAttributes.view<std::int32_t>("groom_group_id"), ElementsAre(3, 3, 7));
}

TEST_F(UsdStages, IdsOf64BitsAreNumberedAnewAndTold) {
    const auto ids = [](const char* numbers) {
        return std::string("    int64[] primvars:groom_id = ") + numbers + " (interpolation = \"uniform\")";
    };
    // Neighbours that are one number as doubles.
    const auto imported = readText(kHead + curves("a", 2, 0, ids("[9007199254740993, 9007199254740992]")) +
                                   curves("b", 1, 1, ids("[-5]")));
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_THAT(imported->groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId),
                ElementsAre(2, 1, 0));
    EXPECT_THAT(said(*imported), HasSubstr("groom_id has numbers of 64 bits"));
}

TEST_F(UsdStages, PartsWithoutUvsColoursOrWidthsAreToldAndLookAsHairDoes) {
    const auto imported = readText(
        kHead +
        curves(
            "a", 2, 0,
            "    float2[] primvars:groom_root_uv = [(0.1, 0.2), (0.3, 0.4)] (interpolation = \"uniform\")\n"
            "    color3f[] primvars:displayColor = [(1, 0, 0), (1, 0, 0), (1, 0, 0), (1, 0, 0)] "
            "(interpolation = "
            "\"vertex\")\n    float[] widths = [0.0002] (interpolation = \"constant\")") +
        curves("b", 1, 0.02));
    ASSERT_TRUE(imported) << imported.error().message();
    for (const char* word : {"root UV", "no colour", "no width"})
        EXPECT_THAT(said(*imported), HasSubstr(word));
    EXPECT_EQ(imported->groom.strandAttributes.view<Vec2f>(attribute::kRootUv)[2], Vec2f(0.3f, 0.4f));
    const auto colours = imported->groom.pointAttributes.view<Vec3f>(attribute::kPointColour);
    EXPECT_EQ(colours[4], HairMaterial{}.rootColour);
    EXPECT_EQ(colours[5], HairMaterial{}.tipColour);
    EXPECT_FLOAT_EQ(imported->groom.pointAttributes.view<float>(attribute::kRadius)[4],
                    HairMaterial{}.rootRadius);
}

TEST_F(UsdStages, UnevenSamplesBecomeEvenFramesAndAreTold) {
    const std::string moving =
        "#usda 1.0\n(\n    metersPerUnit = 1\n    timeCodesPerSecond = 48\n)\n"
        "def BasisCurves \"hair\"\n{\n    uniform token type = \"linear\"\n"
        "    int[] curveVertexCounts = [2]\n    point3f[] points.timeSamples = {\n"
        "        10: [(0, 10, 0), (1, 10, 0)],\n        12: [(0, 12, 0), (1, 12, 0)],\n"
        "        16: [(0, 16, 0), (1, 16, 0)],\n    }\n}\n";
    StrandImportOptions options;
    options.frames = true;
    const auto own = readText(moving, options);
    ASSERT_TRUE(own) << own.error().message();
    EXPECT_FLOAT_EQ(own->framesPerSecond, 24);
    ASSERT_EQ(own->frames.size(), 4u);
    for (std::size_t f = 0; f < 4; ++f)
        EXPECT_FLOAT_EQ(own->frames[f][0].y(), 10 + 2 * static_cast<float>(f));
    EXPECT_THAT(said(*own), HasSubstr("even"));
    options.framesPerSecond = 96;
    const auto asked = readText(moving, options);
    ASSERT_TRUE(asked);
    EXPECT_FLOAT_EQ(asked->framesPerSecond, 96);
    ASSERT_EQ(asked->frames.size(), 13u);
    EXPECT_FLOAT_EQ(asked->frames[7][0].y(), 13.5f);
}

TEST_F(UsdStages, EachPrimIsLookedUpByItsOwnTimes) {
    StrandImportOptions options;
    options.frames = true;
    const auto imported = readText(
        "#usda 1.0\n(\n    metersPerUnit = 1\n    timeCodesPerSecond = 10\n)\n"
        "def Xform \"turns\"\n{\n    double3 xformOp:translate.timeSamples = {\n        0: (0, 0, 0),\n      "
        "  4: (0, 4, "
        "0),\n    }\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n" +
            curves("still", 1) + "}\n" +
            "def BasisCurves \"moves\"\n{\n    uniform token type = \"linear\"\n    int[] curveVertexCounts "
            "= [2]\n"
            "    point3f[] points.timeSamples = {\n        1: [(0, 0, 1), (1, 0, 1)],\n        2: [(0, 0, "
            "2), (1, 0, "
            "2)],\n        3: [(0, 0, 3), (1, 0, 3)],\n    }\n}\n",
        options);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_FLOAT_EQ(imported->framesPerSecond, 10);
    ASSERT_EQ(imported->frames.size(), 5u);
    for (std::size_t f = 0; f < 5; ++f) {
        EXPECT_FLOAT_EQ(imported->frames[f][0].y(), static_cast<float>(f));
        EXPECT_FLOAT_EQ(imported->frames[f][2].z(), std::clamp(static_cast<float>(f), 1.0f, 3.0f));
    }
}

TEST_F(UsdStages, AStageWithoutAUnitIsInCentimetresUnlessAsked) {
    const std::string text = "#usda 1.0\n" + curves("hair", 1, 50);
    const auto assumed = readText(text);
    ASSERT_TRUE(assumed);
    EXPECT_FLOAT_EQ(assumed->groom.strand(0)[0].x(), 0.5f);
    EXPECT_THAT(said(*assumed), HasSubstr("metersPerUnit"));
    StrandImportOptions metres;
    metres.isUnitAsked = true;
    const auto asked = readText(text, metres);
    ASSERT_TRUE(asked);
    EXPECT_FLOAT_EQ(asked->groom.strand(0)[0].x(), 50);
}

TEST_F(UsdStages, WhatStandsTwiceIsAnError) {
    const auto imported =
        readText(kHead + curves("hair", 2, 0,
                                "    int[] primvars:a = [1, 2] (interpolation = \"uniform\")\n"
                                "    float[] primvars:a = [1, 2] (interpolation = \"uniform\")"));
    ASSERT_TRUE(imported) << imported.error().message();
    const auto isIt = [](const Finding& finding) {
        return finding.severity == Severity::Error && finding.where.find("primvars:a") != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(imported->warnings, isIt)) << said(*imported);
}

TEST_F(UsdStages, WidthsThatNoHairHasAreTold) {
    const auto imported =
        readText(kHead + curves("hair", 1, 0, "    float[] widths = [0.02] (interpolation = \"constant\")"));
    ASSERT_TRUE(imported);
    EXPECT_THAT(said(*imported), HasSubstr("a radius is above"));
}

TEST_F(UsdStages, PackagesAreReadAndDamagedOnesRefused) {
    const fs::path package = outsideData() / "field" / "groom.usdz";
    if (!fs::exists(package)) GTEST_SKIP() << package << " is not there";
    const auto imported = importStrands(package);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strandCount(), 10u);
    const auto bytes = readFile(package).value();
    for (std::size_t end = 0; end < bytes.size(); end += 11)
        EXPECT_FALSE(importStrandsFromMemory("cut", std::span(bytes).first(end)));
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        auto damaged = bytes;
        damaged[at] ^= std::byte{0x41};
        static_cast<void>(importStrandsFromMemory("damaged", damaged));
    }
}

TEST_F(UsdStages, FieldFilesGiveWhatPeopleExpectOfThem) {
    const fs::path field = outsideData() / "field";
    if (!fs::exists(field)) GTEST_SKIP() << "no files from the field";
    const std::pair<const char*, std::size_t> expected[] = {{"inactive.usda", 4},
                                                            {"invisible.usda", 4},
                                                            {"payload.usda", 10},
                                                            {"groom.usdz", 10},
                                                            {"hermite.usda", 6},
                                                            {"parts.usda", 60},
                                                            {"flattened_with_class.usda", 2},
                                                            {"nurbs_short_knots.usda", 10},
                                                            {"crate_014.usdc", 1},
                                                            {"primvars_widths.usda", 1}};
    for (const auto& [name, strands] : expected) {
        const auto imported = importStrands(field / name);
        ASSERT_TRUE(imported) << name << ": " << imported.error().message();
        EXPECT_EQ(imported->groom.strandCount(), strands) << name;
    }
    StrandImportOptions all;
    all.frames = true;
    const auto uneven = importStrands(field / "uneven_times.usda", all);
    ASSERT_TRUE(uneven);
    EXPECT_FLOAT_EQ(uneven->framesPerSecond, 24) << "codes 10, 12 and 16 at 48 a second";
    EXPECT_EQ(uneven->frames.size(), 4u);
    EXPECT_THAT(said(*uneven), HasSubstr("at uneven times"));
    EXPECT_THAT(layers(*importStrands(field / "parts.usda")),
                ElementsAre("scalp_hair", "eyebrows", "lashes"));
    const auto centimetres = importStrands(field / "no_unit.usda");
    ASSERT_TRUE(centimetres);
    EXPECT_NEAR(centimetres->groom.strand(0)[0].y(), 1.75f, 0.01f);
}

}  // namespace
}  // namespace hairloom
