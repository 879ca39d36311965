// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/strand_look.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/shading/absorption_layers.h"
#include "core/shading/melanin.h"

namespace hairloom::shading {
namespace {

StrandLook someLook(LookQuantity quantity) {
    StrandLook look;
    look.quantity = quantity;
    look.root = Vec3d(0.2, 0.4, 0.8);
    look.tip = Vec3d(0.6, 0.2, 0.1);
    look.gradient = LinearStep::between(0.25, 0.75);
    look.streakRoot = Vec3d(0.05, 0.1, 0.2);
    look.streakTip = Vec3d(0.01, 0.02, 0.9);
    look.dye = Vec3d(0.9, 0.05, 0.5);
    look.dyeAlong = LinearStep::between(0.5, 1);
    look.ownScale = absorptionScale(0.3);
    return look;
}

TEST(StrandLook, GradientsStreaksAndDyeMixEvenly) {
    const StrandLook look = someLook(LookQuantity::absorption);
    EXPECT_EQ(lookAt(look, {.along = 0.2}), look.root);
    EXPECT_TRUE(lookAt(look, {.along = 0.9}).isApprox(look.tip));
    EXPECT_TRUE(lookAt(look, {.along = 0.5}).isApprox(0.5 * (look.root + look.tip)));
    EXPECT_TRUE(lookAt(look, {.along = 0, .streak = 1}).isApprox(look.streakRoot));
    EXPECT_TRUE(lookAt(look, {.along = 1, .streak = 0.25}).isApprox(0.75 * look.tip + 0.25 * look.streakTip));
    EXPECT_TRUE(lookAt(look, {.along = 1, .streak = 1, .dye = 1}).isApprox(look.dye));
    EXPECT_TRUE(lookAt(look, {.along = 0.75, .dye = 1}).isApprox(0.5 * (look.tip + look.dye)));
    EXPECT_EQ(lookAt(look, {.along = 0.4, .dye = 1}), lookAt(look, {.along = 0.4}));
}

TEST(StrandLook, PigmentOfAStrandIsThatOfItsNaturalHair) {
    StrandLook look = someLook(LookQuantity::absorption);
    look.dyeAlong = LinearStep::between(0, 0);
    EXPECT_EQ(lookAt(look, {.along = 0, .pigment = 0}), Vec3d(Vec3d::Zero())) << "white hair";
    EXPECT_TRUE(lookAt(look, {.along = 0, .pigment = 2.5}).isApprox(2.5 * look.root));
    const Vec3d own(0.5, 0.2, 0.1);
    EXPECT_TRUE(
        lookAt(look, {.pigment = 0.5, .ownColour = &own}).isApprox(0.5 * absorptionOfColour(own, 0.3)));
    EXPECT_TRUE(lookAt(look, {.dye = 1, .pigment = 0}).isApprox(look.dye)) << "dye covers white hair";
    EXPECT_TRUE(lookAt(look, {.streak = 1, .pigment = 0}).isApprox(look.streakRoot)) << "so do dyed streaks";
    look.streakPigment = 1;
    EXPECT_TRUE(lookAt(look, {.streak = 1, .pigment = 0.5}).isApprox(0.5 * look.streakRoot))
        << "bleached ones have pigment";
    // Colours go as the fit of Chiang et al. has it: −ln c as the root of the absorption.
    look.quantity = LookQuantity::colour;
    EXPECT_EQ(lookAt(look, {.along = 0, .pigment = 0}), Vec3d(Vec3d::Ones()));
    const Vec3d twice = lookAt(look, {.along = 0, .pigment = 4});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(twice[c], look.root[c] * look.root[c], 1e-12);
}

TEST(StrandLook, DyeGrowsOutByMetresWithASoftBorder) {
    StrandLook look = someLook(LookQuantity::absorption);
    look.dyeAlong = LinearStep::between(0, 0);
    look.tip = look.root;
    look.regrowth = LinearStep::between(0.02, 0.04);
    for (const double length : {0.05, 0.1, 0.4}) {
        const auto shareAt = [&](double metres) {
            const Vec3d there = lookAt(look, {.along = metres / length, .dye = 1, .length = length});
            return (there.x() - look.root.x()) / (look.dye.x() - look.root.x());
        };
        EXPECT_EQ(shareAt(0), 0);
        EXPECT_EQ(shareAt(0.0199), 0);
        EXPECT_NEAR(shareAt(0.025), 0.15625, 1e-9);  // 3/16 − 2/64
        EXPECT_NEAR(shareAt(0.03), 0.5, 1e-9);
        EXPECT_NEAR(shareAt(0.035), 1 - 0.15625, 1e-9);
        EXPECT_NEAR(shareAt(0.0401), 1, 1e-9);
    }
    EXPECT_TRUE(lookAt(someLook(LookQuantity::absorption), {.along = 1, .dye = 1}).isApprox(look.dye))
        << "none by default";
}

TEST(StrandLook, ColourIsThatOfMuchSuchHair) {
    StrandLook look = someLook(LookQuantity::absorption);
    EXPECT_TRUE(absorptionOfColour(colourAt(look, {.along = 0}), 0.3).isApprox(look.root));
    EXPECT_EQ(colourAt(look, {.pigment = 0}), Vec3d(Vec3d::Ones()));
    look.quantity = LookQuantity::colour;
    EXPECT_EQ(colourAt(look, {.along = 0}), look.root);
}

TEST(StrandLook, ARampWithoutLengthIsAStep) {
    const LinearStep everywhere = LinearStep::between(0, 0);
    EXPECT_EQ(everywhere(0), 1);
    const LinearStep tips = LinearStep::between(0.6, 0.2);
    EXPECT_EQ(tips(0.59), 0);
    EXPECT_EQ(tips(0.6), 1);
}

TEST(StrandLook, OwnColoursAndChanceActAsAbsorption) {
    StrandLook look = someLook(LookQuantity::absorption);
    look.spread = 0.5;
    const Vec3d own(0.5, 0.2, 0.1);
    const Vec3d even = lookAt(look, {.random = 0.5, .ownColour = &own});
    EXPECT_TRUE(even.isApprox(absorptionOfColour(own, 0.3)));
    EXPECT_TRUE(lookAt(look, {.random = 1, .ownColour = &own}).isApprox(1.5 * even));
    // A colour deepens as the fit of Chiang et al. says of hair that absorbs so much more.
    look.quantity = LookQuantity::colour;
    const Vec3d deeper = lookAt(look, {.random = 1, .ownColour = &own});
    EXPECT_TRUE(absorptionOfColour(deeper, 0.3).isApprox(1.5 * absorptionOfColour(own, 0.3)));
}

TEST(AbsorptionLayers, LayerAndAbsorptionAreInverse) {
    for (std::uint32_t layer = 0; layer < kAbsorptionLayers; ++layer) {
        const LayerPlace place = layerPlace(absorptionOfLayer(layer));
        EXPECT_NEAR(place.low + place.part, layer, 1e-9);
    }
    EXPECT_DOUBLE_EQ(absorptionOfLayer(kAbsorptionLayers - 1), kMaxAbsorption);
    const LayerPlace between = layerPlace(1.0);
    EXPECT_NEAR((1 - between.part) * absorptionOfLayer(between.low) +
                    between.part * absorptionOfLayer(between.low + 1),
                1.0, 1e-9);
}

MarschnerParameters rough() {
    MarschnerParameters parameters;
    parameters.azimuthal.width = azimuthalWidth(0.3);
    parameters.azimuthal.causticWidth = 0;
    return parameters;
}

/// N from the layers, as the shader finds it.
Vec3d layered(const MarschnerLayers& layers, double u, double v, std::size_t component, const Vec3d& sigma) {
    Vec3d n;
    const std::uint32_t rows = layers.azimuthal.height / kAbsorptionLayers;
    for (int c = 0; c < 3; ++c) {
        const LayerPlace place = layerPlace(sigma[c]);
        const auto at = [&](std::uint32_t layer) {
            const double row = layer * rows + v * (rows - 1);
            return std::log(
                std::max(layers.azimuthal.sample(u, row / (layers.azimuthal.height - 1))[component], 1e-7));
        };
        n[c] = std::exp((1 - place.part) * at(place.low) + place.part * at(place.low + 1));
    }
    return n;
}

TEST(AbsorptionLayers, AgreeWithTheModelAtAnyAbsorption) {
    const MarschnerLayers layers = bakeMarschnerLayers(rough(), {16, 256, 32});
    Random random(3);
    double wrong = 0, all = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3d sigma(2.5 * random.uniformDouble(), random.uniformDouble(), 0.2 * random.uniformDouble());
        MarschnerParameters parameters = rough();
        parameters.azimuthal.absorption = sigma;
        const double thetaD = 1.4 * random.uniformDouble();
        const AzimuthalProfile::Grid grid = Marschner(parameters).azimuthal(thetaD).grid();
        for (std::size_t k = 0; k < AzimuthalProfile::kGridSize; k += 10) {
            const double cosPhi = std::cos(static_cast<double>(k) * 3.14159265358979 / 180);
            for (const std::size_t component : {std::size_t{0}, std::size_t{1}}) {
                const Vec3d n =
                    layered(layers, 0.5 * cosPhi + 0.5, thetaD / (3.14159265358979 / 2), component, sigma);
                for (std::size_t c = 0; c < 3; ++c) {
                    const double expected =
                        static_cast<double>(component == 0 ? grid.tt[c][k] : grid.trt[c][k]);
                    wrong += (n[static_cast<int>(c)] - expected) * (n[static_cast<int>(c)] - expected);
                    all += expected * expected;
                }
            }
        }
    }
    RecordProperty("error", std::to_string(std::sqrt(wrong / all)));
    EXPECT_LT(std::sqrt(wrong / all), 0.01);
}

TEST(AbsorptionLayers, SadeghiFollowsTheFibre) {
    MarschnerParameters from = rough(), to = rough();
    from.azimuthal.absorption = Vec3d(0.1, 0.2, 0.4);
    to.azimuthal.absorption = Vec3d(0.5, 0.9, 1.8);
    const SadeghiParameters moved =
        withAbsorption(sadeghiLike(Marschner(from)), from.azimuthal, to.azimuthal.absorption);
    const SadeghiParameters made = sadeghiLike(Marschner(to));
    // TRT has the same width in both; TT's azimuthal width, and its height with it, depend on the absorption.
    EXPECT_TRUE(moved.trt.colour.isApprox(made.trt.colour, 1e-9));
    EXPECT_NEAR(moved.trt.intensity, made.trt.intensity, 1e-9 * made.trt.intensity);
    EXPECT_TRUE(moved.tt.colour.isApprox(made.tt.colour, 1e-9));
    EXPECT_NEAR(moved.tt.intensity * moved.ttAzimuthalWidth, made.tt.intensity * made.ttAzimuthalWidth,
                1e-9 * made.tt.intensity);
}

}  // namespace
}  // namespace hairloom::shading
