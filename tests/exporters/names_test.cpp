// SPDX-License-Identifier: GPL-3.0-or-later
// Names, units and layers of what is written, looked at as a foreign reader would.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/file.h"
#include "exporters/exported_attributes.h"
#include "exporters/strands.h"
#include "importers/usd_stage.h"
#include "tests/exporters/asset_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using test::helices;
using testing::ElementsAre;
using testing::HasSubstr;

class Names : public test::ExportTest {
  protected:
    UsdStage written(const Groom& groom, const std::string& format, const StrandExportOptions& options = {}) {
        const fs::path path = folder / ("a." + format);
        const auto report = strandWriter(format).write(groom, path, options);
        EXPECT_TRUE(report) << report.error().message();
        auto stage = openUsdStage(path.string(), readFile(path).value(), {});
        EXPECT_TRUE(stage) << stage.error().message();
        return stage ? std::move(*stage) : UsdStage();
    }
    static std::set<std::string> namesOf(const UsdPrim& prim) {
        std::set<std::string> names;
        for (const UsdAttribute& attribute : prim.attributes)
            EXPECT_TRUE(names.insert(attribute.name).second) << attribute.name;
        return names;
    }
};

TEST_F(Names, BecomeLegalAndStayDifferent) {
    NameGiver usd(isLegalInUsd);
    EXPECT_EQ(usd.give("Hair.L"), "Hair_L");
    EXPECT_EQ(usd.give("Hair_L"), "Hair_L_2");
    EXPECT_EQ(usd.give("Hair_L_2"), "Hair_L_2_2");
    EXPECT_EQ(usd.give("\xe9\xa0\xad"), "_") << "one underscore for a character";
    EXPECT_EQ(usd.give("\xe9\xa6\x96"), "__2");
    EXPECT_EQ(usd.give("7th"), "_7th");
    EXPECT_EQ(usd.give(""), "__3");
    EXPECT_TRUE(isGivenTo("Hair_L_2", "Hair.L", isLegalInUsd));
    EXPECT_FALSE(isGivenTo("width", "Width of hair", isLegalInUsd)) << "a title, no name";
}

TEST_F(Names, EachStandsOnceAndTheOriginalComesBack) {
    Groom groom = helices({3, 4});
    const std::vector<std::string> odd{"bone_weight_Hair.L",
                                       "bone_weight_Hair_L",
                                       "bone_weight_\xe9\xa0\xad",
                                       "bone_weight_\xe9\xa6\x96",
                                       "widths",
                                       "a b",
                                       "a:b"};
    float value = 1;
    for (const std::string& name : odd) {
        groom.strandAttributes.set(name, std::vector<float>{value, value + 0.5f});
        value += 1;
    }
    groom.pointAttributes.set("a b", std::vector<float>(7, 0.5f));
    for (const std::string format : {"usda", "usdc"}) {
        const UsdStage stage = written(groom, format);
        EXPECT_TRUE(stage.repeated.empty());
        namesOf(stage.root.children.at(0).children.at(0));
        const auto back = importStrands(folder / ("a." + format));
        ASSERT_TRUE(back) << back.error().message();
        for (const std::string& name : odd) {
            if (name == "a b") continue;
            EXPECT_THAT(back->groom.strandAttributes.view<float>(name),
                        testing::ElementsAreArray(groom.strandAttributes.view<float>(name)))
                << format << " " << name;
        }
    }
}

TEST_F(Names, TheAuthorsValueStandsUnderTheExportersName) {
    Groom groom = helices({2, 2});
    groom.strandAttributes.set("groom_id", std::vector<std::int32_t>{-1, -1});
    groom.strandAttributes.set("groom_color", std::vector<Vec3f>(2, Vec3f(0.1f, 0.2f, 0.3f)));
    groom.strandAttributes.set("groom_width", std::vector<float>{0.0001f, 0.0002f});
    groom.pointAttributes.set(attribute::kPointColour, std::vector<Vec3f>(4, Vec3f(0.5f, 0.6f, 0.7f)));
    StrandExportOptions centimetres;
    centimetres.metresPerUnit = 0.01f;
    for (const std::string format : {"usda", "usdc"}) {
        const UsdStage stage = written(groom, format, centimetres);
        const UsdPrim& hair = stage.root.children.at(0).children.at(0);
        EXPECT_THAT(namesOf(hair), testing::IsSupersetOf({"primvars:groom_id", "primvars:groom_color",
                                                          "primvars:displayColor", "primvars:groom_width"}));
        EXPECT_EQ(hair.find("primvars:groom_id")->value.numbers.whole(1), -1);
        EXPECT_EQ(hair.find("primvars:groom_color")->interpolation, "uniform");
        EXPECT_NEAR(hair.find("primvars:groom_width")->value.numbers[1], 0.02, 1e-7) << "in the file's unit";
        const auto back = importStrands(folder / ("a." + format));
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->groom.strandAttributes.view<float>("groom_width")[1], 0.0002f, 1e-9f);
        EXPECT_THAT(back->groom.strandAttributes.view<std::int32_t>("groom_id"), ElementsAre(-1, -1));
        EXPECT_EQ(back->groom.pointAttributes.view<Vec3f>(attribute::kPointColour)[3],
                  Vec3f(0.5f, 0.6f, 0.7f));
    }
    const auto unreal = strandWriter("abc-unreal").write(groom, folder / "u.abc", centimetres);
    ASSERT_TRUE(unreal) << unreal.error().message();
    EXPECT_LT(unreal->maxErrorMm.value(), 1e-3);
}

TEST_F(Names, RestPositionsAndVelocitiesFollowUnitAndAxis) {
    Groom groom = helices({2});
    groom.pointAttributes.set("Pref", std::vector<Vec3f>(2, Vec3f(1, 2, 3)));
    groom.pointAttributes.set("velocity", std::vector<Vec3f>(2, Vec3f(0, 0, 0.5f)));
    StrandExportOptions options;
    options.metresPerUnit = 0.01f;
    options.up = UpAxis::Z;
    const UsdStage stage = written(groom, "usdc", options);
    const UsdPrim& hair = stage.root.children.at(0).children.at(0);
    const auto numbers = [&](const char* name) {
        const std::vector<double> all = hair.find(name)->value.numbers.doubles();
        return std::vector<double>(all.begin(), all.begin() + 3);
    };
    EXPECT_THAT(numbers("primvars:Pref"),
                testing::Pointwise(testing::DoubleNear(1e-3), {100.0, -300.0, 200.0}));
    EXPECT_THAT(numbers("primvars:velocity"),
                testing::Pointwise(testing::DoubleNear(1e-3), {0.0, -50.0, 0.0}));
    const auto back = importStrands(folder / "a.usdc");
    ASSERT_TRUE(back);
    EXPECT_LT((back->groom.pointAttributes.view<Vec3f>("Pref")[0] - Vec3f(1, 2, 3)).norm(), 1e-5f);
}

TEST_F(Names, TheExtentHasHalfTheWidth) {
    Groom groom = helices({8});
    groom.pointAttributes.set(attribute::kRadius, std::vector<float>(8, 0.001f));
    const UsdStage stage = written(groom, "usdc");
    const UsdPrim& hair = stage.root.children.at(0).children.at(0);
    const Box3f bounds = groom.bounds();
    EXPECT_NEAR(hair.find("extent")->value.numbers[0], static_cast<double>(bounds.min().x()) - 0.001, 1e-7);
    EXPECT_NEAR(hair.find("extent")->value.numbers[5], static_cast<double>(bounds.max().z()) + 0.001, 1e-7);
}

TEST_F(Names, IdsBeyondSignedNumbersAreNumberedAnewWithAWord) {
    Groom groom = helices({2, 2});
    groom.strandAttributes.set(attribute::kStrandId, std::vector<std::uint32_t>{4'000'000'000u, 7});
    const auto report = strandWriter("usda").write(groom, folder / "a.usda", {});
    ASSERT_TRUE(report);
    EXPECT_THAT(
        importStrands(folder / "a.usda")->groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId),
        ElementsAre(1, 0));
    EXPECT_TRUE(
        std::ranges::any_of(report->findings, [](const Finding& f) { return f.where == "groom_id"; }));
}

TEST_F(Names, AHeadWithoutUvsGivesNoRootUvs) {
    PolygonSoup soup;
    soup.positions = {{-1, 1.69f, -1}, {-1, 1.69f, 1}, {1, 1.69f, 1}, {1, 1.69f, -1}};
    soup.corners = {0, 1, 2, 3};
    soup.offsets = {0, 4};
    Groom groom = helices({8, 8});
    groom.scalp = std::make_shared<const ScalpMesh>(ScalpMesh::make(soup).value());
    groom.strandAttributes.set(attribute::kRootUv, std::vector<Vec2f>(2, Vec2f::Zero()));
    const UsdStage stage = written(groom, "usda");
    EXPECT_EQ(stage.root.children.at(0).children.at(0).find("primvars:groom_root_uv"), nullptr);
}

TEST_F(Names, WhatTheFieldStatesTwiceGoesOutOnce) {
    const fs::path field = outsideData() / "field";
    if (!fs::exists(field)) GTEST_SKIP() << "no files from the field";
    for (const char* name : {"ids_of_two_parts", "colour_twice", "width_twice"}) {
        const auto groom = importStrands(field / (std::string(name) + ".usda"));
        ASSERT_TRUE(groom) << name;
        for (const std::string format : {"usda", "usdc"}) {
            const UsdStage stage = written(groom->groom, format);
            EXPECT_TRUE(stage.repeated.empty()) << name;
            for (const UsdPrim& prim : stage.root.children.at(0).children) namesOf(prim);
        }
    }
}

}  // namespace
}  // namespace hairloom
