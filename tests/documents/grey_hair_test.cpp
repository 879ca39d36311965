// SPDX-License-Identifier: GPL-3.0-or-later
// White strands, melanin by strand, dye that has grown out, and the looks that have them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/documents/look_presets.h"
#include "core/documents/sample.h"
#include "core/documents/strand_values.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/point_dye.h"
#include "core/interpolation/follow_hairs.h"
#include "core/live/hair_look.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

Result<Groom> shortHair() {
    return makeSample(sourceDir() / "samples", "short");
}

ViewFile marschner() {
    ViewFile view;
    view.fibre.model = render::ShadingModel::marschner;
    return view;
}

Groom twoStrands() {
    Groom groom = makeGroom({0, 2, 4}, {Vec3f(0, 0, 0), Vec3f(0, 1, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0)});
    groom.material.tipColour = groom.material.rootColour;
    return groom;
}

TEST(GreyHair, AShareOfStrandsIsWhiteAndKeepsThatInAnyOrder) {
    auto groom = shortHair();
    ASSERT_TRUE(groom) << groom.error().message();
    EXPECT_TRUE(weightsOfStrands(*groom).pigments.empty());
    const auto whiteOf = [](const std::vector<float>& pigments) {
        return static_cast<double>(std::ranges::count(pigments, 0.0f)) / static_cast<double>(pigments.size());
    };
    groom->material.greyShare = 0.3f;
    const std::vector<float> some = weightsOfStrands(*groom).pigments;
    ASSERT_EQ(some.size(), groom->strandCount());
    EXPECT_TRUE(strandMaterials(*groom, marschner()).material.look);
    const double deviation = std::sqrt(0.3 * 0.7 / static_cast<double>(some.size()));
    EXPECT_NEAR(whiteOf(some), 0.3, 4 * deviation);
    groom->material.greyShare = 0.7f;
    const std::vector<float> more = weightsOfStrands(*groom).pigments;
    for (std::size_t s = 0; s < some.size(); ++s) ASSERT_TRUE(some[s] != 0 || more[s] == 0) << s;
    groom->material.greySeed = 2;
    EXPECT_NE(weightsOfStrands(*groom).pigments, more);
    groom->material.greySeed = 1;
    groom->material.greyShare = 1;
    EXPECT_EQ(whiteOf(weightsOfStrands(*groom).pigments), 1);
    groom->material.greyShare = 0.3f;
    // Every third strand, from the last to the first, as a level with fewer hairs has them.
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> points;
    std::vector<float> expected;
    for (std::size_t s = groom->strandCount(); s-- > 0;) {
        if (s % 3 != 0) continue;
        points.insert(points.end(), groom->strand(s).begin(), groom->strand(s).end());
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
        expected.push_back(some[s]);
    }
    Groom fewer = makeGroom(offsets, points);
    fewer.material = groom->material;
    EXPECT_EQ(weightsOfStrands(fewer).pigments, expected);
    groom->interpolation.followPerGuide = 2;
    const auto bindings = bindFollowHairs(*groom, groom->interpolation);
    ASSERT_TRUE(bindings);
    const auto hairs = weightsOfFollowHairs(*groom, *bindings);
    ASSERT_TRUE(hairs);
    ASSERT_EQ(hairs->pigments.size(), bindings->hairCount());
    EXPECT_NEAR(whiteOf(hairs->pigments), 0.3, 4 * deviation) << "each hair for itself, not with its guide";
}

TEST(GreyHair, WhiteStrandsStayWhiteWhenAFileRoundsTheirRoots) {
    auto groom = shortHair();
    ASSERT_TRUE(groom) << groom.error().message();
    const auto roots = static_cast<double>(groom->strandCount());
    groom->material.greyShare = 0.5f;
    const std::vector<float> before = weightsOfStrands(*groom).pigments;
    std::vector<Vec3f>& positions = groom->pointAttributes.edit<Vec3f>(attribute::kPosition);
    for (Vec3f& p : positions) p = (p.array() * 1e6f).round().matrix() / 1e6f;  // micrometres
    const std::vector<float> after = weightsOfStrands(*groom).pigments;
    double changed = 0;
    for (std::size_t s = 0; s < before.size(); ++s) changed += before[s] != after[s] ? 1 : 0;
    EXPECT_LT(changed, 0.02 * roots);
}

TEST(GreyHair, MelaninThatIsNoNumberIsThatOfTheMaterial) {
    Groom groom = twoStrands();
    groom.strandAttributes.set(attribute::kMelanin, std::vector<float>{std::nanf(""), -2});
    EXPECT_EQ(weightsOfStrands(groom).pigments, (std::vector<float>{1, 0}));
}

TEST(GreyHair, BakedFollowHairsKeepDyeAndMelanin) {
    auto groom = shortHair();
    ASSERT_TRUE(groom) << groom.error().message();
    std::vector<float> shares(groom->strandCount());
    for (std::size_t s = 0; s < shares.size(); ++s) shares[s] = s % 2 == 0 ? 1.0f : 0.25f;
    groom->strandAttributes.set(attribute::kMelanin, shares);
    groom->strandAttributes.set(attribute::kDye, shares);
    groom->material.dyeStrength = 1;
    groom->interpolation.followPerGuide = 2;
    const auto bindings = bindFollowHairs(*groom, groom->interpolation);
    ASSERT_TRUE(bindings);
    auto baked = bakeFollowHairs(*groom, *bindings);
    ASSERT_TRUE(baked);
    const auto hairs = weightsOfFollowHairs(*groom, *bindings);
    ASSERT_TRUE(hairs);
    const LookWeights own = weightsOfStrands(*baked);
    EXPECT_EQ(own.pigments, hairs->pigments);
    EXPECT_EQ(own.dyes, hairs->dyes);
    EXPECT_LE(*std::ranges::max_element(own.pigments), 1);
    EXPECT_GE(*std::ranges::min_element(own.pigments), 0.25f);
    groom->strandAttributes.erase(attribute::kDye);
    groom->pointAttributes.set(attribute::kPointDye, std::vector<float>(groom->pointCount(), 0.5f));
    baked = bakeFollowHairs(*groom, *bindings);
    ASSERT_TRUE(baked);
    for (const float dye : weightsOfStrands(*baked).pointDyes) ASSERT_NEAR(dye, 0.5f, 1e-5f);
}

TEST(GreyHair, MelaninOfStrandsComesFromAnAttributeAndIsLimited) {
    auto groom = shortHair();
    ASSERT_TRUE(groom) << groom.error().message();
    std::vector<float> values(groom->strandCount(), 0.5f);
    values[0] = 20;
    values[1] = -1;
    groom->strandAttributes.set("depth", values);
    EXPECT_FALSE(melaninFromAttribute("no_such", *groom));
    ASSERT_TRUE(melaninFromAttribute("depth", *groom));
    EXPECT_TRUE(strandMaterials(*groom, marschner()).material.look);
    const std::vector<float> pigments = weightsOfStrands(*groom).pigments;
    EXPECT_EQ(pigments[0], 8);
    EXPECT_EQ(pigments[1], 0);
    EXPECT_EQ(pigments[2], 0.5f);
    groom->interpolation.followPerGuide = 2;
    const auto bindings = bindFollowHairs(*groom, groom->interpolation);
    ASSERT_TRUE(bindings);
    const auto hairs = weightsOfFollowHairs(*groom, *bindings);
    ASSERT_TRUE(hairs);
    EXPECT_GT(std::ranges::count_if(hairs->pigments, [](float p) { return std::abs(p - 0.5f) < 1e-5f; }),
              static_cast<long>(bindings->hairCount()) / 2);
    values[2] = std::nanf("");
    groom->strandAttributes.set("depth", values);
    EXPECT_FALSE(melaninFromAttribute("depth", *groom));
}

TEST(GreyHair, LengthsAreKnownWhereDyeHasGrownOut) {
    Groom groom = twoStrands();
    groom.material.dyeRegrowth = 0.02f;
    EXPECT_TRUE(weightsOfStrands(groom).lengths.empty()) << "there is no dye";
    groom.material.dyeStrength = 1;
    EXPECT_EQ(weightsOfStrands(groom).lengths, std::vector<float>(2, 1.0f));
    const auto look = strandMaterials(groom, marschner()).material.look;
    ASSERT_TRUE(look);
    EXPECT_EQ(look->regrowth(0.01), 0);
    EXPECT_EQ(look->regrowth(0.03), 1);
    groom.material.dyeRegrowth = 0;
    EXPECT_EQ(strandMaterials(groom, marschner()).material.look->regrowth(0), 1);
}

TEST(GreyHair, DyeGrowsOutByMetresWherePointsAreUneven) {
    Groom groom = makeGroom({0, 4, 6}, {Vec3f(0, 0, 0), Vec3f(0, 0.01f, 0), Vec3f(0, 0.05f, 0),
                                        Vec3f(0, 0.2f, 0), Vec3f(1, 0, 0), Vec3f(1, 0.01f, 0)});
    groom.material.dyeStrength = 1;
    groom.material.dyeRegrowth = 0.03f;
    const std::vector<float> lengths = weightsOfStrands(groom).lengths;
    ASSERT_EQ(lengths.size(), 2u);
    EXPECT_NEAR(lengths[0] * 0.5f, 0.03f, 1e-6f) << "three centimetres are half of its points";
    EXPECT_NEAR(lengths[1], 0.01f, 1e-6f) << "all of it has grown since";
}

TEST(GreyHair, CombingLeavesAGrownOutDyeAndCuttingMovesIt) {
    Groom groom = twoStrands();
    groom.material.dyeStrength = 1;
    groom.material.dyeRegrowth = 0.02f;
    auto scene = GroomScene::make(groom, marschner(), {});
    ASSERT_TRUE(scene);
    const std::vector<std::uint32_t> second{1};
    EXPECT_TRUE(scene->moveStrands(second, std::vector<Vec3f>{Vec3f(1, 0, 0), Vec3f(1, 0.8f, 0.6f)}));
    EXPECT_FALSE(scene->moveStrands(second, std::vector<Vec3f>{Vec3f(1, 0, 0), Vec3f(1, 0.5f, 0)}));
    groom.material.dyeRegrowth = 0.04f;
    EXPECT_FALSE(scene->setMaterials(groom, marschner())) << "lengths are those of the border";
}

TEST(GreyHair, APresetTakesAwayWhatAnotherOneAdded) {
    HairMaterial material;
    applyLook(*findLook("brown"), material);
    const HairMaterial brown = material;
    for (const LookPreset& preset : lookPresets()) {
        if (!preset.extras) continue;
        applyLook(preset, material);
        EXPECT_NE(toJson(material), toJson(brown)) << preset.name;
        EXPECT_EQ(material.shadingModel, brown.shadingModel) << preset.name;
        applyLook(*findLook("brown"), material);
        EXPECT_EQ(toJson(material), toJson(brown)) << preset.name;
    }
    applyLook(*findLook("salt and pepper"), material);
    material.greyShare = 0.2f;
    applyLook(*findLook("brown"), material);
    EXPECT_EQ(material.greyShare, 0.2f) << "what a person sets stays";
}

TEST(GreyHair, LooksOfAnotherThicknessTakeTheRadiiOfPoints) {
    const std::vector<std::string> thick{"peach fuzz", "brows", "lashes"};
    Groom groom = twoStrands();
    for (const LookPreset& preset : lookPresets()) {
        groom.pointAttributes.set(attribute::kRadius, std::vector<float>(4, 1e-3f));
        applyLook(preset, groom);
        const bool goes = std::ranges::find(thick, preset.name) != thick.end();
        EXPECT_EQ(groom.pointAttributes.has(attribute::kRadius), !goes) << preset.name;
    }
}

}  // namespace
}  // namespace hairloom
