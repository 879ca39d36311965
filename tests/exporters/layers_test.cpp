// SPDX-License-Identifier: GPL-3.0-or-later
// Layers as prims, objects and groups of files, both ways, and the script that Unreal runs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/file.h"
#include "core/geometry/scalp_mesh.h"
#include "exporters/strands.h"
#include "importers/alembic_archive.h"
#include "importers/usd_stage.h"
#include "tests/exporters/asset_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using test::helices;
using testing::ElementsAre;
using testing::HasSubstr;

class LayersOut : public test::ExportTest {
  protected:
    fs::path write(const Groom& groom, const std::string& format, const StrandExportOptions& options = {}) {
        const HairWriter& writer = strandWriter(format);
        const fs::path path = folder / ("a-" + format + "." + writer.suffix());
        const auto report = writer.write(groom, path, options);
        EXPECT_TRUE(report) << format << ": " << report.error().message();
        if (report) last = *report;
        return path;
    }
    ExportReport last;
};

/// Strands of four layers by turns, one layer without any; names that no format takes as they are.
Groom layered(std::vector<std::string> names, std::uint32_t points = 0) {
    Groom groom =
        points ? helices({points, points, points, points, points, points}) : helices({2, 3, 4, 5, 6, 7});
    groom.layers.clear();
    for (std::string& name : names) groom.layers.emplace_back().name = std::move(name);
    groom.strandAttributes.set(attribute::kLayer, std::vector<std::uint32_t>{2, 0, 1, 0, 2, 1});
    return groom;
}

const std::vector<std::string> kOddNames{"Fringe (left)", "Fringe_(left)", "\xe9\xa0\xad/b.c", "none of it"};

/// Each strand of the file is one of the groom's, of the same layer by name, in the layer's order.
void expectSameLayers(const Groom& groom, const Groom& back, float tolerance) {
    ASSERT_EQ(back.strandCount(), groom.strandCount());
    const auto layers = back.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    const auto authored = groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    ASSERT_EQ(layers.size(), groom.strandCount());
    std::vector<std::size_t> order;
    for (std::uint32_t layer = 0; layer < groom.layers.size(); ++layer) {
        for (std::size_t s = 0; s < authored.size(); ++s) {
            if (authored[s] == layer) order.push_back(s);
        }
    }
    for (std::size_t s = 0; s < order.size(); ++s) {
        EXPECT_EQ(back.layers[layers[s]].name, groom.layers[authored[order[s]]].name) << s;
        const auto a = back.strand(s), b = groom.strand(order[s]);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t p = 0; p < a.size(); ++p) EXPECT_LE((a[p] - b[p]).norm(), tolerance);
    }
}

TEST_F(LayersOut, ComeBackFromEveryFormatThatHasThem) {
    const Groom groom = layered(kOddNames);
    for (const std::string format : {"usda", "usdc", "abc", "obj-lines"}) {
        const auto back = importStrands(write(groom, format));
        ASSERT_TRUE(back) << back.error().message();
        SCOPED_TRACE(format);
        expectSameLayers(groom, back->groom, 0);
    }
    const Groom even = layered(kOddNames, 5);
    const auto ribbons = importStrands(write(even, "obj-c4d"));
    ASSERT_TRUE(ribbons) << ribbons.error().message();
    expectSameLayers(even, ribbons->groom, 1e-6f);
}

TEST_F(LayersOut, OfUnrealAreGroupsWithNames) {
    const Groom groom = layered(kOddNames);
    StrandExportOptions metres;
    const auto back = importStrands(write(groom, "abc-unreal", metres), {1.0f, true});
    ASSERT_TRUE(back) << back.error().message();
    const auto layers = back->groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    const auto authored = groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    const auto numbers = back->groom.strandAttributes.view<std::int32_t>("groom_group_id");
    ASSERT_EQ(layers.size(), 6u);
    ASSERT_EQ(numbers.size(), 6u);
    for (std::size_t s = 0; s < 6; ++s) {
        EXPECT_EQ(back->groom.layers[layers[s]].name, kOddNames[authored[s]]);
        EXPECT_EQ(numbers[s], static_cast<std::int32_t>(authored[s]));
        EXPECT_TRUE(std::ranges::equal(back->groom.strand(s), groom.strand(s)));
    }
    // And once more, with what came in.
    const auto again = importStrands(write(back->groom, "abc-unreal", metres), {1.0f, true});
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_THAT(again->groom.strandAttributes.view<std::int32_t>("groom_group_id"),
                testing::ElementsAreArray(numbers));
    const auto kept = again->groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    ASSERT_EQ(kept.size(), 6u);
    for (std::size_t s = 0; s < 6; ++s) EXPECT_EQ(again->groom.layers[kept[s]].name, kOddNames[authored[s]]);
}

TEST_F(LayersOut, OneLayerKeepsItsNameAndNoneIsMadeUp) {
    for (const std::string format : {"usda", "usdc", "abc", "obj-lines"}) {
        SCOPED_TRACE(format);
        Groom groom = helices({3, 4});
        groom.layers[0].name = "Brows / C:\\left";
        const auto named = importStrands(write(groom, format));
        ASSERT_TRUE(named) << named.error().message();
        ASSERT_EQ(named->groom.layers.size(), 1u);
        EXPECT_EQ(named->groom.layers[0].name, "Brows / C:\\left");
        const auto plain = importStrands(write(helices({3, 4}), format));
        ASSERT_TRUE(plain) << plain.error().message();
        ASSERT_EQ(plain->groom.layers.size(), 1u);
        EXPECT_EQ(plain->groom.layers[0].name, Layer{}.name);
    }
}

TEST_F(LayersOut, ObjectsAndGroupsOfObjAreLayers) {
    const auto layersOf = [&](const std::string& text) {
        const auto back = importStrandsFromMemory("a.obj", std::as_bytes(std::span(text)));
        EXPECT_TRUE(back) << back.error().message();
        std::vector<std::string> names;
        if (!back) return names;
        const auto layers = back->groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
        for (std::size_t s = 0; s < back->groom.strandCount(); ++s)
            names.push_back(back->groom.layers[layers.empty() ? 0 : layers[s]].name);
        return names;
    };
    const std::string points = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 0\nv 3 1 0\n";
    EXPECT_THAT(layersOf(points + "g one\nl 1 2\ng two\nl 3 4\nl 5 6\ng one\nl 7 8\n"),
                ElementsAre("one", "two", "two", "one"));
    EXPECT_THAT(layersOf(points + "o My Hair\nl 1 2\no Beard\nl 3 4\nl 5 6\nl 7 8\n"),
                ElementsAre("My Hair", "Beard", "Beard", "Beard"));
    EXPECT_THAT(layersOf(points + "l 1 2\ng tail\nl 3 4\nl 5 6\nl 7 8\n"),
                ElementsAre("Hair", "tail", "tail", "tail"));
    EXPECT_THAT(layersOf(points + "o head\ng a\nl 1 2\ng b\nl 3 4\no brows\ng a\nl 5 6\nl 7 8\n"),
                ElementsAre("head/a", "head/b", "brows/a", "brows/a"));
    EXPECT_THAT(layersOf("o all\n" + points + "l 1 2\nl 3 4\nl 5 6\nl 7 8\n"),
                ElementsAre("all", "all", "all", "all"));
}

TEST_F(LayersOut, ThousandsOfObjectsAreOneLayer) {
    std::string text;
    for (int s = 0; s < 300; ++s)
        text += "o Curve." + std::to_string(s) + "\nv 0 0 0\nv 0 0.1 0\nv 0 0.2 0\nl -3 -2 -1\n";
    const auto back = importStrandsFromMemory("a.obj", std::as_bytes(std::span(text)));
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->groom.strandCount(), 300u);
    ASSERT_EQ(back->groom.layers.size(), 1u);
    EXPECT_EQ(back->groom.layers[0].name, Layer{}.name);
}

TEST_F(LayersOut, MovingObjectsOfAlembicHaveTheirOwnPointsAndVelocities) {
    Groom groom = layered(kOddNames);
    StrandFrames frames{24, 10, {}};
    for (int f = 0; f < 3; ++f) {
        std::vector<Vec3f> points(groom.positions().begin(), groom.positions().end());
        for (std::size_t p = 0; p < points.size(); ++p)
            points[p].x() += 0.01f * static_cast<float>(f * f) * static_cast<float>(p);
        frames.points.push_back(std::move(points));
    }
    StrandExportOptions options;
    options.frames = std::make_shared<const StrandFrames>(frames);
    const fs::path path = write(groom, "abc", options);
    const auto bytes = readFile(path).value();
    const auto archive = AlembicArchive::open("a.abc", bytes);
    ASSERT_TRUE(archive);
    const auto top = archive->children(archive->top()).value();
    const auto objects = archive->children(top.at(0)).value();
    ASSERT_EQ(objects.size(), 3u) << "of the layers that have strands";
    // The first layer has strands 1 and 3: points 2 to 4 and 9 to 13.
    const auto properties = archive->properties(archive->children(objects[0]).value().at(0)).value();
    const auto inside = archive->properties(*findProperty(properties, ".geom")).value();
    const auto* const velocities = findProperty(inside, ".velocities");
    ASSERT_NE(velocities, nullptr);
    EXPECT_EQ(velocities->samples, 3u);
    EXPECT_EQ(velocities->metadata.at("interpretation"), "vector");
    const auto middle = archive->floats(*velocities, 1).value();
    ASSERT_EQ(middle.size(), 8u * 3);
    EXPECT_NEAR(middle[0], 0.01f * 4 * 2 * 24 / 2, 1e-4f) << "from the frame before to the one after";
    EXPECT_NEAR(middle[3 * 3], 0.01f * 4 * 9 * 24 / 2, 1e-4f);
    EXPECT_NEAR(archive->floats(*velocities, 0).value()[0], 0.01f * 2 * 24, 1e-4f);
}

TEST_F(LayersOut, SettingsAndOperatorsComeBackFromUsdBitForBit) {
    Groom groom = layered({"Fringe", "Tail", "Brows", "empty"});
    groom.layers[1].material = HairMaterial{};
    groom.layers[1].material->rootColour = Vec3f(0.1f, 0.2f, 0.3f);
    groom.layers[2].density = 0.3f;
    groom.layers[3].locked = true;
    groom.material.eumelanin = 0.123456789f;
    groom.material.shadingModel = ShadingModel::marschner;
    groom.simulation.gravity.y = -9.123456f;
    groom.interpolation.followPerGuide = 7;
    groom.placement.seed = 123456789012345ull;
    groom.spheres.push_back({"head \"1\"", Vec3f(0, 1.5f, 0.1f), 0.09f, "neck\\bone"});
    groom.operators.push_back({"trim", "{\"keep\":0.5}", true, 0.25f, 0});
    std::vector<Vec3f> base(groom.positions().begin(), groom.positions().end());
    for (Vec3f& point : base) point *= 1.7f;
    groom.pointAttributes.set(attribute::kBasePosition, base);
    for (const std::string format : {"usda", "usdc"}) {
        SCOPED_TRACE(format);
        const fs::path path = write(groom, format);
        EXPECT_TRUE(std::ranges::none_of(last.leftBehind, [](const LeftBehind& one) {
            return one.what.find("settings") != std::string::npos;
        }));
        const auto back = importStrands(path);
        ASSERT_TRUE(back) << back.error().message();
        EXPECT_TRUE(back->hasSettings);
        EXPECT_EQ(back->groom.simulation, groom.simulation);
        EXPECT_EQ(back->groom.material.eumelanin, groom.material.eumelanin);
        EXPECT_EQ(back->groom.material.shadingModel, ShadingModel::marschner);
        EXPECT_EQ(back->groom.interpolation.followPerGuide, 7u);
        EXPECT_EQ(back->groom.placement.seed, groom.placement.seed);
        ASSERT_EQ(back->groom.spheres.size(), 1u);
        EXPECT_EQ(back->groom.spheres[0].name, "head \"1\"");
        EXPECT_EQ(back->groom.spheres[0].bone, "neck\\bone");
        ASSERT_EQ(back->groom.layers.size(), 4u);
        ASSERT_TRUE(back->groom.layers[1].material);
        EXPECT_EQ(back->groom.layers[1].material->rootColour, Vec3f(0.1f, 0.2f, 0.3f));
        EXPECT_EQ(back->groom.layers[2].density, 0.3f);
        EXPECT_TRUE(back->groom.layers[3].locked);
        expectSameLayers(groom, back->groom, 0);
        ASSERT_EQ(back->groom.operators.size(), 1u);
        EXPECT_EQ(back->groom.operators[0].op, "trim");
        EXPECT_EQ(back->groom.operators[0].weight, 0.25f);
        const auto from = back->groom.pointAttributes.view<Vec3f>(attribute::kBasePosition);
        ASSERT_EQ(from.size(), groom.pointCount());
        EXPECT_EQ(from[0], back->groom.positions()[0] * 1.7f);
        // In another unit points are not those that operators made.
        StrandExportOptions centimetres;
        centimetres.metresPerUnit = 0.01f;
        const auto other = importStrands(write(groom, format, centimetres));
        ASSERT_TRUE(other);
        EXPECT_TRUE(other->groom.operators.empty());
        EXPECT_EQ(other->groom.simulation, groom.simulation);
    }
    // Hair that somebody has moved since is none that operators made.
    std::string text = readTextFile(write(groom, "usda")).value();
    const std::size_t at = text.find("point3f[] points = [(") + 21;
    text.replace(at, 1, text[at] == '-' ? "-1" : "1");
    const auto moved = importStrandsFromMemory("a.usda", std::as_bytes(std::span(text)));
    ASSERT_TRUE(moved) << moved.error().message();
    EXPECT_TRUE(moved->groom.operators.empty());
    EXPECT_TRUE(
        std::ranges::any_of(moved->warnings, [](const Finding& f) { return f.where == "operators"; }));
    // Settings that no version has are told, and the strands come in.
    text = readTextFile(write(groom, "usda")).value();
    text.replace(text.find("eumelanin"), 9, "eumelanon");
    const auto odd = importStrandsFromMemory("a.usda", std::as_bytes(std::span(text)));
    ASSERT_TRUE(odd) << odd.error().message();
    EXPECT_EQ(odd->groom.strandCount(), 6u);
    EXPECT_FALSE(odd->hasSettings);
    EXPECT_TRUE(std::ranges::any_of(
        odd->warnings, [](const Finding& f) { return f.what.find("eumelanon") != std::string::npos; }));
}

TEST_F(LayersOut, UsdHasMaterialsAndTheScalpBesideTheCurves) {
    Groom groom = layered({"scalp", "materials", "Brows"});
    groom.layers[2].material = HairMaterial{};
    PolygonSoup soup;
    soup.positions = {{-1, 1.69f, -1}, {-1, 1.69f, 1}, {1, 1.69f, 1}, {1, 1.69f, -1}};
    soup.corners = {0, 1, 2, 3};
    soup.offsets = {0, 4};
    groom.scalp = std::make_shared<const ScalpMesh>(ScalpMesh::make(soup).value());
    groom.scalpSelection = {1};
    for (const std::string format : {"usda", "usdc"}) {
        SCOPED_TRACE(format);
        const auto stage = openUsdStage("a." + format, readFile(write(groom, format)).value(), {});
        ASSERT_TRUE(stage) << stage.error().message();
        EXPECT_TRUE(stage->repeated.empty());
        const UsdPrim& hair = stage->root.children.at(0);
        std::vector<std::string> names;
        for (const UsdPrim& prim : hair.children) names.push_back(prim.type + " " + prim.name);
        EXPECT_THAT(names, ElementsAre("BasisCurves scalp", "BasisCurves materials", "BasisCurves Brows",
                                       "Mesh scalp_2", "Scope materials_2"));
        EXPECT_THAT(hair.children[0].find("material:binding")->value.texts,
                    ElementsAre("/groom/materials_2/hair"));
        EXPECT_THAT(hair.children[2].find("material:binding")->value.texts,
                    ElementsAre("/groom/materials_2/Brows"));
        EXPECT_EQ(hair.children[3].find("points")->value.numbers.size(), 9u) << "of one triangle";
        const UsdPrim& material = hair.children[4].children.at(0);
        EXPECT_EQ(material.type, "Material");
        const UsdPrim* const fibre = material.child("fibre");
        ASSERT_NE(fibre, nullptr);
        EXPECT_THAT(fibre->find("info:id")->value.texts, ElementsAre("ND_chiang_hair_bsdf"));
    }
}

std::pair<int, std::string> outputOf(const std::string& command) {
    std::pair<int, std::string> ended{-1, {}};
    FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return ended;
    std::array<char, 4096> block{};
    for (std::size_t read = 0; (read = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
        ended.second.append(block.data(), read);
    ended.first = pclose(pipe);
    return ended;
}

#ifndef _WIN32
TEST_F(LayersOut, UnrealsScriptUsesWhatItsApiPublishes) {
    if (outputOf("python3 --version").first != 0) GTEST_SKIP() << "no Python here";
    Groom groom = layered({"Fringe \"left\"", "\xe9\xa0\xad", "Tail\\", "none of it"});
    groom.strandAttributes.set(attribute::kGuide, std::vector<std::uint8_t>{1, 0, 0, 0, 0, 1});
    StrandExportOptions options;
    options.metresPerUnit = 0.01f;
    const fs::path path = write(groom, "abc-unreal", options);
    ASSERT_THAT(last.companions, ElementsAre("a-abc-unreal_unreal.py"));
    const std::string script = (folder / last.companions[0]).string();
    const std::string stub = "PYTHONDONTWRITEBYTECODE=1 python3 " +
                             (sourceDir() / "tests" / "interop" / "unreal_stub.py").string() + " " + script;
    const auto right = outputOf(stub + " '0:Fringe \"left\":2:0' '1:\xe9\xa0\xad:1:1' '2:Tail\\:1:1'");
    EXPECT_EQ(right.first, 0) << right.second;
    EXPECT_THAT(right.second, HasSubstr("rotation 90.0 0.0 0.0 scale 1.0 -1.0 1.0"));
    EXPECT_THAT(right.second, HasSubstr("/Game/Test/a_abc_unreal GroomAsset"));
    EXPECT_THAT(right.second, HasSubstr("/Game/Test/a_abc_unreal_Binding GroomBindingAsset"));
    EXPECT_THAT(right.second, HasSubstr("refused: /Game/Missing is no skeletal mesh"));
    const auto wrong = outputOf(stub + " '0:Fringe \"left\":2:0' '1:other:1:1'");
    EXPECT_NE(wrong.first, 0);
    EXPECT_THAT(wrong.second, HasSubstr("group 2 (Tail\\) is missing"));
    EXPECT_THAT(wrong.second, HasSubstr("and is 'other'"));
    // Z up in metres.
    options.metresPerUnit = 1;
    options.up = UpAxis::Z;
    write(groom, "abc-unreal", options);
    EXPECT_THAT(outputOf(stub + " '0:Fringe \"left\":2:0' '1:\xe9\xa0\xad:1:1' '2:Tail\\:1:1'").second,
                HasSubstr("rotation 0.0 0.0 0.0 scale 100.0 -100.0 100.0"));
}
#endif

}  // namespace
}  // namespace hairloom
