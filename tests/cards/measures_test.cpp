// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/cards/levels.h"

namespace hairloom::cards {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t kSide = 256;
constexpr double kPixelMm = 1;

/// A picture without a background: what hair covers above a row, skin below it, each of one luminance.
Print headWithHair(std::uint32_t hairline, float hairLight = 0.05f, float skinLight = 0.3f) {
    Print print{kSide, kSide, {}, {}, {}};
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const bool isHair = y < hairline;
            print.hair.push_back(isHair ? 1.0f : 0.0f), print.skin.push_back(isHair ? 0.0f : 1.0f);
            print.light.push_back(isHair ? hairLight : skinLight);
        }
    }
    return print;
}

Measures measured(const Print& strands, const Print& level, double pixelMm = kPixelMm) {
    const ViewMeasures view = measureView(strands, level, pixelMm);
    return combined(std::span(&view, 1));
}

TEST(Measures, OfStrandsBesideThemselvesAreAsGoodAsCanBe) {
    const Print print = headWithHair(120);
    const Measures same = measured(print, print);
    EXPECT_EQ(same.largestPatchCm2, 0);
    EXPECT_EQ(same.hairlineMm, 0);
    EXPECT_EQ(same.rim, 1);
    EXPECT_EQ(same.holes, 0);
    EXPECT_FALSE(same.scaliness) << "the light is the same everywhere";
    EXPECT_FALSE(same.motionPx) << "pictures do not tell";
    EXPECT_THAT(failsOf(same, kPixelMm), IsEmpty());
    EXPECT_EQ(failureWords(same, kPixelMm), "");
}

TEST(Measures, FindTheAreaOfADiscThatIsBare) {
    const Print strands = headWithHair(200);
    Print level = strands;
    const auto bare = [&](double middleX, double middleY, double radius) {
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x)
                if (std::hypot(x + 0.5 - middleX, y + 0.5 - middleY) < radius)
                    level.hair[y * kSide + x] = 0, level.skin[y * kSide + x] = 1;
    };
    bare(60, 60, 10), bare(180, 90, 20);
    for (const double pixelMm : {1.0, 0.5}) {
        const auto patch = measured(strands, level, pixelMm).largestPatchCm2;
        EXPECT_NEAR(*patch, kPi * 400 * pixelMm * pixelMm / 100, 0.1 * pixelMm * pixelMm)
            << "the larger of two";
    }
    EXPECT_THAT(failsOf(measured(strands, level), kPixelMm), testing::Contains("largest_patch_cm2"));
    EXPECT_EQ(measured(strands, level).largestPatchCm2, measured(level, strands).largestPatchCm2)
        << "a flap over bare skin counts as much";
    // Where strands leave skin bare themselves there is none.
    EXPECT_EQ(measured(level, level).largestPatchCm2, 0);
    // A bridge of a pixel makes one of two.
    for (std::uint32_t x = 60; x < 180; ++x) {
        const std::uint32_t y = 60 + (x - 60) / 4;
        for (const std::uint32_t i : {y * kSide + x, (y + 1) * kSide + x})
            level.hair[i] = 0, level.skin[i] = 1;
    }
    EXPECT_GT(*measured(strands, level).largestPatchCm2, kPi * 500 / 100);
}

TEST(Measures, TellHowFarAHairlineWasMoved) {
    for (const std::uint32_t by : {1u, 3u})
        for (const double pixelMm : {1.0, 0.5}) {
            EXPECT_NEAR(*measured(headWithHair(120), headWithHair(120 + by), pixelMm).hairlineMm,
                        by * pixelMm, 1e-9);
            EXPECT_NEAR(*measured(headWithHair(120 + by), headWithHair(120), pixelMm).hairlineMm,
                        by * pixelMm, 1e-9)
                << "forwards and backwards alike";
        }
    EXPECT_NEAR(*measured(headWithHair(120), headWithHair(60)).hairlineMm, 5, 1e-9) << "at most";
    EXPECT_NEAR(*measured(headWithHair(120), headWithHair(0)).hairlineMm, 5, 1e-9) << "nor is none a way out";
    EXPECT_THAT(failsOf(measured(headWithHair(120), headWithHair(122)), kPixelMm),
                testing::Contains("hairline_mm"));
    EXPECT_THAT(failsOf(measured(headWithHair(120), headWithHair(121)), kPixelMm),
                testing::Not(testing::Contains("hairline_mm")));
}

TEST(Measures, SeeARimThatIsDarker) {
    const Print strands = headWithHair(120);
    for (const float darker : {0.9f, 0.5f}) {
        Print level = strands;
        for (std::uint32_t y = 117; y < 120; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) level.light[y * kSide + x] *= darker;
        EXPECT_NEAR(*measured(strands, level).rim, static_cast<double>(darker), 1e-6);
        EXPECT_NEAR(*measured(level, strands).rim, 1 / static_cast<double>(darker), 1e-5);
    }
    Print level = strands;
    for (std::uint32_t i = 0; i < 80 * kSide; ++i) level.light[i] = 0;
    EXPECT_EQ(measured(strands, level).rim, 1) << "what lies inside is no rim";
}

/// Waves of so many pixels and of that much more or less light.
Print waved(Print print, double pixels, double contrast) {
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x)
            print.light[y * kSide + x] +=
                static_cast<float>(contrast * std::sin(2 * static_cast<double>(kPi) * x / pixels));
    return print;
}

TEST(Measures, KnowTheSpectrumOfNoise) {
    const Print plain = headWithHair(kSide);
    // Power goes by the square of the contrast.
    for (const double pixels : {5.0, 8.0, 13.0})
        EXPECT_NEAR(*measured(waved(plain, pixels, 0.01), waved(plain, pixels, 0.02)).scaliness, 4, 0.01);
    // Waves that are longer or shorter do not count.
    const Print base = waved(plain, 8, 0.01);
    for (const double pixels : {256.0, 2.2})
        EXPECT_NEAR(*measured(base, waved(base, pixels, 0.02)).scaliness, 1, 0.05);
    // An octave counts as much as another: white noise of the same power in pixels.
    const auto noisy = [&](float contrast, std::uint64_t seed) {
        Print print = plain;
        for (std::uint32_t i = 0; i < kSide * kSide; ++i)
            print.light[i] += contrast * Random(seed, i).uniform(-1.0f, 1.0f);
        return print;
    };
    EXPECT_NEAR(*measured(noisy(0.01f, 1), noisy(0.01f, 2)).scaliness, 1, 0.1);
    const Measures rough = measured(noisy(0.01f, 1), noisy(0.02f, 2));
    EXPECT_NEAR(*rough.scaliness, 4, 0.4);
    EXPECT_THAT(failsOf(rough, kPixelMm), testing::Contains("scaliness"));
    EXPECT_THAT(failsOf(measured(noisy(0.02f, 1), noisy(0.01f, 2)), kPixelMm), testing::Contains("scaliness"))
        << "nor may it be smeared";
    EXPECT_FALSE(measured(headWithHair(20), headWithHair(20)).scaliness) << "no square is full of hair";
}

TEST(Measures, CountHolesWhereTheBackgroundShowsThrough) {
    Print strands = headWithHair(100);
    for (std::uint32_t i = 100 * kSide; i < kSide * kSide; ++i) strands.skin[i] = 0;  // hair before nothing
    Print level = strands;
    for (std::uint32_t y = 40; y < 50; ++y)
        for (std::uint32_t x = 40; x < 60; ++x) level.hair[y * kSide + x] = 0.2f;
    const Measures open = measured(strands, level);
    EXPECT_NEAR(*open.holes, 200.0 / (100 * kSide), 1e-9);
    EXPECT_THAT(failsOf(open, kPixelMm), ElementsAre("holes"));
    EXPECT_EQ(failureWords(open, kPixelMm), "holes 0.781 % (at most 0.5)");
    EXPECT_FALSE(open.largestPatchCm2) << "there is no head";
    EXPECT_FALSE(open.hairlineMm);
    EXPECT_FALSE(open.rim);
    // What is off at the outline has a measure of its own.
    level = strands;
    for (std::uint32_t x = 0; x < kSide; ++x) level.hair[99 * kSide + x] = 0;
    EXPECT_EQ(measured(strands, level).holes, 0);
}

TEST(Measures, AreTheWorstPatchAndTheMeanOfTheRestOverDirections) {
    const Print strands = headWithHair(120);
    Print bare = strands;
    for (std::uint32_t i = 0; i < 50; ++i) bare.hair[i] = 0, bare.skin[i] = 1;
    const std::array views{measureView(strands, bare, 1), measureView(strands, headWithHair(123), 1)};
    const Measures both = combined(views);
    EXPECT_DOUBLE_EQ(*both.largestPatchCm2, 3 * kSide / 100.0) << "of the one that is covered";
    EXPECT_LT(*both.hairlineMm, 3);
    EXPECT_GT(*both.hairlineMm, 1);
}

TEST(Measures, AreLessStrictWherePixelsHideThem) {
    Measures measures;
    measures.largestPatchCm2 = 0.3, measures.hairlineMm = 2.5;
    EXPECT_THAT(failsOf(measures, pixelMillimetres(256)), ElementsAre("largest_patch_cm2", "hairline_mm"));
    EXPECT_THAT(failsOf(measures, pixelMillimetres(64)), IsEmpty());
    measures.motionPx = 1.6;
    EXPECT_THAT(failsOf(measures, pixelMillimetres(64)), ElementsAre("motion_px"))
        << "those are pixels already";
}

TEST(Measures, OfCoarserPicturesAreOfMeans) {
    Print print = headWithHair(1);
    print.light[0] = 0.25f;
    const Print half = coarser(print, 2);
    EXPECT_EQ(half.width, kSide / 2);
    EXPECT_FLOAT_EQ(half.hair[0], 0.5f);
    EXPECT_FLOAT_EQ(half.light[0], (0.25f + 0.05f + 0.3f + 0.3f) / 4);
    EXPECT_EQ(half.skin[kSide / 2], 1);
}

}  // namespace
}  // namespace hairloom::cards
