// SPDX-License-Identifier: GPL-3.0-or-later
// What of a groom's material reaches the renderer.
#include "core/live/hair_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/documents/sample.h"
#include "core/documents/strand_values.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "core/render/png.h"
#include "tests/support/source_dir.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

const std::filesystem::path kSamples = sourceDir() / "samples";

ViewFile viewOf(render::ShadingModel model) {
    ViewFile view;
    view.fibre.model = model;
    return view;
}
const ViewFile kKajiya = viewOf(render::ShadingModel::kajiya);
const ViewFile kMarschner = viewOf(render::ShadingModel::marschner);

Groom plainGroom() {
    Groom groom = makeGroom({0, 2, 4}, {Vec3f(0, 0, 0), Vec3f(0, 1, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0)});
    groom.material.tipColour = groom.material.rootColour;
    return groom;
}

TEST(HairLook, ClumpingIsMeasuredOfTheHairAtRest) {
    // Wisps of eight, a millimetre wide.
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> points;
    for (std::uint32_t i = 0; i < 800; ++i) {
        const auto wisp = static_cast<float>(i / 8), hair = static_cast<float>(i % 8);
        const Vec3f root(0.01f * std::fmod(wisp, 10.0f) + 0.0001f * hair, 0, 0.01f * std::floor(wisp / 10));
        points.insert(points.end(), {root, root + Vec3f(0, 0.1f, 0)});
        offsets.push_back(2 * (i + 1));
    }
    const Groom groom = makeGroom(offsets, points);
    auto scene = GroomScene::make(groom, kMarschner, {});
    ASSERT_TRUE(scene);
    const render::Clumping rest = render::measureClumping(scene->scene().strands);
    EXPECT_LT(rest.widest(), 0.9f);
    EXPECT_EQ(scene->scene().clumping.values, rest.values);
    for (Vec3f& p : points) p *= 2;
    scene->pose(points, {}, {});
    EXPECT_EQ(scene->scene().clumping.values, rest.values);
}

TEST(HairLook, EccentricFibresGlintOverAWiderRange) {
    Groom groom = plainGroom();
    const auto sadeghi = [&] {
        return strandMaterials(groom, viewOf(render::ShadingModel::sadeghi)).material.fibre.sadeghi;
    };
    const shading::SadeghiParameters round = sadeghi();
    EXPECT_NEAR(round.glintNear, 30 * shading::kDegree, 1e-6);
    EXPECT_NEAR(round.glintFar, 45 * shading::kDegree, 1e-6);
    double width = round.glintFar - round.glintNear;
    for (const float eccentricity : {0.3f, 0.6f, 0.8f}) {
        groom.material.eccentricity = eccentricity;
        const shading::SadeghiParameters elliptic = sadeghi();
        EXPECT_LT(elliptic.glintNear, round.glintNear);
        EXPECT_GT(elliptic.glintFar, round.glintFar);
        EXPECT_GE(elliptic.glintNear, 0);
        EXPECT_GT(elliptic.glintFar - elliptic.glintNear, width);
        width = elliptic.glintFar - elliptic.glintNear;
        // a/b of b²/a² = 1 − e².
        EXPECT_NEAR(strandMaterials(groom, kKajiya).material.axisRatio,
                    1 / std::sqrt(1 - eccentricity * eccentricity), 1e-5f);
    }
}

TEST(HairLook, CausticsAreAsRoughnessAsksUnlessAuthored) {
    Groom groom = plainGroom();
    const auto azimuthal = [&](render::ShadingModel model) {
        return strandMaterials(groom, viewOf(model)).material.fibre.marschner.azimuthal;
    };
    EXPECT_EQ(azimuthal(render::ShadingModel::marschner).causticWidth, 0);
    groom.material.azimuthalRoughness = 0.01f;
    shading::AzimuthalParameters smooth = azimuthal(render::ShadingModel::marschner);
    const shading::AzimuthalParameters usual;
    EXPECT_EQ(smooth.causticWidth, usual.causticWidth);
    EXPECT_NEAR(smooth.causticFade, usual.causticFade, 1e-7);
    EXPECT_EQ(smooth.glint, usual.glint);
    EXPECT_EQ(smooth.roots, usual.roots);
    const shading::AzimuthalParameters sadeghi = azimuthal(render::ShadingModel::sadeghi);
    for (const float roughness : {0.01f, 0.4f}) {
        groom.material.azimuthalRoughness = roughness;
        groom.material.causticWidthDegrees = 9;
        groom.material.causticFade = 0.6f;
        groom.material.causticIntensity = 4;
        groom.material.azimuthalSolver = AzimuthalSolver::cubic;
        const shading::AzimuthalParameters made = azimuthal(render::ShadingModel::marschner);
        EXPECT_NEAR(made.causticWidth, 9 * shading::kDegree, 1e-6);
        EXPECT_NEAR(made.causticFade, 0.6, 1e-6);
        EXPECT_NEAR(made.glint, 4, 1e-6);
        EXPECT_EQ(made.roots, shading::RootMethod::Cubic);
    }
    groom.material.azimuthalRoughness = 0.01f;
    EXPECT_EQ(azimuthal(render::ShadingModel::sadeghi), sadeghi)
        << "Sadeghi's glints are controls of their own";
}

TEST(HairLook, PaintedWidthsAreInAllRadii) {
    Groom groom = plainGroom();
    groom.material.rootRadius = 4e-5f;
    groom.material.tipScale = 0.5f;
    groom.layers = {{"Own", true, false, 1, {}}, {"Other", true, false, 1, {}}};
    groom.layers[1].material = groom.material;
    groom.layers[1].material->rootRadius = 1e-4f;
    groom.strandAttributes.set(attribute::kLayer, std::vector<std::uint32_t>{0, 1});
    const auto radii = [](const GroomScene& scene) {
        const render::RenderStrands strands = scene.scene().strands.front();
        EXPECT_TRUE(strands.radii.empty() || strands.radiiOfAll);
        return std::vector<float>(strands.radii.begin(), strands.radii.end());
    };
    EXPECT_TRUE(radii(GroomScene::make(groom, kKajiya, {}).value()).empty());
    groom.pointAttributes.set(attribute::kWidthChange, std::vector<float>{0, 1, -0.5f, 3});
    auto scene = GroomScene::make(groom, kKajiya, {}).value();
    EXPECT_EQ(radii(scene), (std::vector<float>{4e-5f, 4e-5f, 5e-5f, 2e-4f}));
    // Another material, and other strokes, without a scene made anew.
    groom.material.rootRadius = 8e-5f;
    ASSERT_TRUE(scene.setMaterials(groom, kKajiya));
    EXPECT_EQ(radii(scene), (std::vector<float>{8e-5f, 8e-5f, 5e-5f, 2e-4f}));
    groom.pointAttributes.set(attribute::kWidthChange, std::vector<float>{1, 0, 0, 0});
    ASSERT_TRUE(scene.setWidths(groom));
    EXPECT_EQ(radii(scene), (std::vector<float>{1.6e-4f, 4e-5f, 1e-4f, 5e-5f}));
    groom.pointAttributes.erase(attribute::kWidthChange);
    EXPECT_FALSE(scene.setWidths(groom));
    // Points' own radii are changed, too, but not those in a layer with a material.
    groom.pointAttributes.set(attribute::kRadius, std::vector<float>(4, 1e-5f));
    groom.pointAttributes.set(attribute::kWidthChange, std::vector<float>(4, 1));
    EXPECT_EQ(radii(GroomScene::make(groom, kKajiya, {}).value()),
              (std::vector<float>{2e-5f, 2e-5f, 2e-4f, 1e-4f}));
}

TEST(HairLook, EvenHairHasNone) {
    const Groom plain = plainGroom();
    EXPECT_FALSE(strandMaterials(plain, kKajiya).material.look);
    EXPECT_FALSE(strandMaterials(plain, kMarschner).material.look);
    // Colours are nothing to fibres that take melanin.
    Groom coloured = plain;
    coloured.material.tipColour = Vec3f(0.5f, 0.1f, 0.9f);
    EXPECT_TRUE(strandMaterials(coloured, kKajiya).material.look);
    EXPECT_FALSE(strandMaterials(coloured, kMarschner).material.look);
    coloured.material.colourSource = ColourSource::colours;
    const auto dyed = strandMaterials(coloured, kMarschner).material.look;
    ASSERT_TRUE(dyed);
    EXPECT_TRUE(dyed->tip.isApprox(
        shading::absorptionOfColour(coloured.material.tipColour.cast<double>(),
                                    static_cast<double>(coloured.material.azimuthalRoughness))));
}

TEST(HairLook, EachFeatureAsksForOne) {
    const std::vector<std::function<void(Groom&)>> features = {
        [](Groom& g) { g.material.streakShare = 0.1f; },
        [](Groom& g) { g.material.dyeStrength = 0.1f; },
        [](Groom& g) { g.material.melaninVariation = 0.1f; },
        [](Groom& g) { g.material.emission = 0.1f; },
    };
    for (std::size_t i = 0; i < features.size(); ++i) {
        Groom groom = plainGroom();
        features[i](groom);
        EXPECT_TRUE(strandMaterials(groom, kKajiya).material.look) << i;
        EXPECT_TRUE(strandMaterials(groom, kMarschner).material.look) << i;
    }
    Groom bleached = plainGroom();
    bleached.material.tipMelanin = 0.25f;
    EXPECT_FALSE(strandMaterials(bleached, kKajiya).material.look);
    const auto look = strandMaterials(bleached, kMarschner).material.look;
    ASSERT_TRUE(look);
    EXPECT_TRUE(look->tip.isApprox(0.25 * look->root));
    Groom own = plainGroom();
    own.strandAttributes.set(attribute::kStrandColour, std::vector<Vec3f>(2, Vec3f(1, 0, 0)));
    EXPECT_TRUE(strandMaterials(own, kMarschner).material.look);
    // A view that says what colour hair has means all of it.
    ViewFile view = kMarschner;
    view.fibre.melanin = shading::Melanin{0.3, 0};
    EXPECT_FALSE(strandMaterials(bleached, view).material.look);
}

TEST(HairLook, LayersHaveMaterialsOfTheirOwnAndHiddenOnesAreNotDrawn) {
    auto groom = makeSample(kSamples, "short");
    ASSERT_TRUE(groom) << groom.error().message();
    EXPECT_TRUE(materialsOfStrands(*groom).empty()) << "all have the one";
    groom->layers = {{"Base", true, false, 1, {}},
                     {"Fringe", true, false, 1, groom->material},
                     {"Hidden", false, false, 1, {}},
                     {"Brows", true, false, 2, groom->material}};
    groom->layers[1].material->rootRadius = 0.0001f;
    groom->layers[3].material->dyeStrength = 0.5f;
    groom->layers[3].material->streakShare = 0.4f;
    std::vector<std::uint32_t> layers(groom->strandCount());
    for (std::uint32_t s = 0; s < layers.size(); ++s) layers[s] = s % 4;
    groom->strandAttributes.set(attribute::kLayer, layers);
    std::vector<std::uint8_t> hidden(groom->strandCount(), 0);
    hidden[5] = 1;
    groom->strandAttributes.set(attribute::kHidden, hidden);
    const StrandMaterials made = strandMaterials(*groom, kKajiya);
    ASSERT_EQ(made.others.size(), 2u);
    EXPECT_EQ(made.others[0].radius, 0.0001f);
    const auto ofStrands = materialsOfStrands(*groom);
    const std::uint32_t expected[] = {0, 1, render::kNotDrawn, 2};
    for (std::size_t s = 0; s < 40; ++s)
        EXPECT_EQ(ofStrands[s], s == 5 ? render::kNotDrawn : expected[s % 4]);
    groom->interpolation.followPerGuide = 2;
    const auto bindings = bindFollowHairs(*groom, groom->interpolation);
    ASSERT_TRUE(bindings);
    const auto ofHairs = materialsOfFollowHairs(*groom, *bindings);
    ASSERT_EQ(ofHairs.size(), bindings->hairCount());
    const auto weights = weightsOfFollowHairs(*groom, *bindings);
    ASSERT_TRUE(weights);
    bool streaked = false;
    for (std::size_t h = 0; h < ofHairs.size(); ++h) {
        EXPECT_EQ(ofHairs[h], ofStrands[bindings->guideStrands[bindings->guides[h][0]]]);
        ASSERT_EQ(weights->dyes[h], ofHairs[h] == 2 ? 0.5f : 0.0f);
        ASSERT_TRUE(ofHairs[h] == 2 || weights->streaks[h] == 0);
        streaked = streaked || weights->streaks[h] > 0;
    }
    EXPECT_TRUE(streaked);
}

TEST(HairLook, DyeComesFromTheMaskAndFollowHairsShareIt) {
    auto groom = makeSample(kSamples, "short");
    ASSERT_TRUE(groom) << groom.error().message();
    groom->material.dyeStrength = 0.5f;
    EXPECT_EQ(weightsOfStrands(*groom).dyes, std::vector<float>(groom->strandCount(), 0.5f));
    std::vector<float> mask(groom->strandCount());
    for (std::size_t s = 0; s < mask.size(); ++s) mask[s] = groom->strand(s)[0].x() > 0 ? 1.0f : 0.0f;
    groom->strandAttributes.set("right_half", mask);
    EXPECT_FALSE(dyeFromAttribute("no_such", *groom));
    ASSERT_TRUE(dyeFromAttribute("right_half", *groom));
    groom->material.streakShare = 0.3f;
    groom->interpolation.followPerGuide = 2;
    const auto bindings = bindFollowHairs(*groom, groom->interpolation);
    ASSERT_TRUE(bindings);
    const auto shares = weightsOfFollowHairs(*groom, *bindings);
    ASSERT_TRUE(shares);
    ASSERT_EQ(shares->dyes.size(), bindings->hairCount());
    ASSERT_EQ(shares->streaks.size(), bindings->hairCount());
    const auto rest = bakeFollowHairs(*groom, *bindings);
    ASSERT_TRUE(rest);
    for (std::size_t h = 0; h < shares->dyes.size(); h += 7) {
        const float x = rest->strand(h)[0].x();
        if (std::abs(x) > 0.02f) {
            EXPECT_NEAR(shares->dyes[h], x > 0 ? 0.5f : 0.0f, 1e-5f) << h;
        }
    }
}

TEST(HairLook, PaintedDyeIsThatOfThePointsAndAnotherMaskReplacesIt) {
    auto groom = makeSample(kSamples, "short");
    ASSERT_TRUE(groom) << groom.error().message();
    groom->material.dyeStrength = 0.5f;
    std::vector<float> painted(groom->pointCount());
    for (std::size_t s = 0; s < groom->strandCount(); ++s) {
        const std::uint32_t first = groom->offsets[s], last = groom->offsets[s + 1] - 1;
        for (std::uint32_t p = first; p <= last; ++p)
            painted[p] = static_cast<float>(p - first) / static_cast<float>(last - first);
    }
    groom->pointAttributes.set(attribute::kPointDye, painted);
    const LookWeights own = weightsOfStrands(*groom);
    EXPECT_EQ(own.pointDyes, painted);
    EXPECT_EQ(own.dyes, std::vector<float>(groom->strandCount(), 0.5f));
    groom->interpolation.followPerGuide = 2;
    const auto bindings = bindFollowHairs(*groom, groom->interpolation);
    ASSERT_TRUE(bindings);
    const auto shares = weightsOfFollowHairs(*groom, *bindings);
    ASSERT_TRUE(shares);
    ASSERT_EQ(shares->pointDyes.size(), bindings->hairCount() * bindings->pointsPerHair);
    for (std::size_t p = 0; p < shares->pointDyes.size(); ++p) {
        const auto along = static_cast<float>(p % bindings->pointsPerHair);
        ASSERT_NEAR(shares->pointDyes[p], along / static_cast<float>(bindings->pointsPerHair - 1), 1e-5f);
    }
    groom->strandAttributes.set("all", std::vector<float>(groom->strandCount(), 1.0f));
    ASSERT_TRUE(dyeFromAttribute("all", *groom));
    EXPECT_TRUE(weightsOfStrands(*groom).pointDyes.empty());
}

TEST(HairLook, AnImageOverTheRootUvsIsAMask) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "mask.png";
    render::Image image{2, 2, {}};
    for (const int grey : {255, 0, 0, 128}) {
        for (int c = 0; c < 3; ++c) image.rgba.push_back(static_cast<std::uint8_t>(grey));
        image.rgba.push_back(255);
    }
    ASSERT_TRUE(render::writePng(path, image));
    Groom groom = plainGroom();
    EXPECT_FALSE(dyeFromImage(path.string(), groom)) << "no root UVs";
    groom.strandAttributes.set(attribute::kRootUv, std::vector<Vec2f>{{0.25f, 0.75f}, {1.75f, 0.25f}});
    ASSERT_TRUE(dyeFromImage(path.string(), groom));
    const auto mask = groom.strandAttributes.view<float>(attribute::kDye);
    EXPECT_NEAR(mask[0], 1.0f, 1e-3f);
    EXPECT_NEAR(mask[1], 128.0f / 255, 2e-3f);
    groom.strandAttributes.erase(attribute::kDye);
    ASSERT_TRUE(melaninFromImage(path.string(), groom));
    EXPECT_NEAR(weightsOfStrands(groom).pigments[1], 128.0f / 255, 2e-3f);
    EXPECT_FALSE(groom.strandAttributes.has(attribute::kDye));
    ASSERT_TRUE(stiffnessFromImage(path.string(), {0.5f, 8}, groom));
    const auto stiffness = groom.strandAttributes.view<float>(attribute::kStiffness);
    EXPECT_NEAR(stiffness[0], 8, 1e-2f);
    EXPECT_NEAR(stiffness[1], 0.5f + 7.5f * 128 / 255, 1e-2f);
    const auto missing = melaninFromImage(path.string() + ".none", groom);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message().find(".none"), std::string::npos);
    groom.strandAttributes.erase(attribute::kRootUv);
    EXPECT_FALSE(melaninFromImage(path.string(), groom)) << "no root UVs";
}

}  // namespace
}  // namespace hairloom
