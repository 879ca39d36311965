// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "core/cards/raster.h"
#include "tests/cards/card_samples.h"

namespace hairloom::cards {
namespace {

TEST(Raster, ThinLinesCoverAsMuchAsTheirAreaSays) {
    double covered = 0, area = 0;
    for (int i = 0; i < 200; ++i) {
        const float turn = 0.031f * static_cast<float>(i);
        const Vec2f middle(100.3f, 99.7f), way(80 * std::cos(turn), 80 * std::sin(turn));
        const Vec2f radius = Vec2f::Constant(0.2f);
        forSamplesOfLine({middle - way, radius}, {middle + way, radius}, 200, {0, 200},
                         [&](int, int, float) { covered += 1; });
        area += 160 * 0.4;
    }
    EXPECT_NEAR(covered / area, 1, 0.03);
}

TEST(Raster, LinesHaveTheSameSamplesInBandsAsInOnePiece) {
    // Steep, flat and upright lines, thick and thin, that leave the picture, too.
    for (int i = 0; i < 60; ++i) {
        const float turn = 0.11f * static_cast<float>(i);
        const Vec2f middle(31.3f, 60.7f), way(45 * std::cos(turn), 45 * std::sin(turn));
        const Vec2f radius = Vec2f::Constant(i % 2 == 0 ? 0.2f : 3.3f);
        const LinePoint a{middle - way, radius}, b{middle + way, 0.5f * radius};
        std::vector<std::array<float, 3>> whole, pieces;
        const auto into = [](auto& list) {
            return [&list](int x, int y, float t) {
                list.push_back({static_cast<float>(x), static_cast<float>(y), t});
            };
        };
        forSamplesOfLine(a, b, 80, {0, 90}, into(whole));
        const Rows touched = rowsOfLine(a, b, 90);
        for (const auto& sample : whole) {
            ASSERT_GE(sample[1], static_cast<float>(touched.first)) << i;
            ASSERT_LT(sample[1], static_cast<float>(touched.end)) << i;
        }
        for (int row = 0; row < 90; row += 7)
            forSamplesOfLine(a, b, 80, {row, std::min(row + 7, 90)}, into(pieces));
        std::ranges::sort(whole), std::ranges::sort(pieces);
        ASSERT_EQ(whole, pieces) << i;
    }
}

TEST(Raster, TrianglesHaveTheSameSamplesInBandsAsInOnePiece) {
    // Of either orientation, thin ones and ones that leave the picture, too.
    std::vector<std::array<float, 5>> whole, pieces;
    std::size_t samples = 0;
    for (std::uint32_t i = 0; i < 300; ++i) {
        whole.clear(), pieces.clear();
        const auto corner = [&](std::uint32_t k) {
            return Vec2f(130 * hashUnit(i, k, 1) - 25, 140 * hashUnit(i, k, 2) - 25);
        };
        const Vec2f a = corner(0), b = corner(1);
        const Vec2f c = i % 3 == 0 ? Vec2f(b + 0.01f * (corner(2) - b)) : corner(2);
        const auto into = [](auto& list) {
            return [&list](int x, int y, const Vec3f& w) {
                list.push_back({static_cast<float>(x), static_cast<float>(y), w.x(), w.y(), w.z()});
            };
        };
        forSamplesOfTriangle(a, b, c, 80, 90, into(whole));
        const Rows touched = rowsOfTriangle(a, b, c, {0, 90});
        for (const auto& sample : whole) {
            ASSERT_GE(sample[1], static_cast<float>(touched.first)) << i;
            ASSERT_LT(sample[1], static_cast<float>(touched.end)) << i;
        }
        for (int row = 0; row < 90; row += 7)
            forSamplesOfTriangle(a, b, c, 80, Rows{row, std::min(row + 7, 90)}, into(pieces),
                                 NothingHidden());
        ASSERT_EQ(whole, pieces) << i;
        samples += whole.size();
    }
    EXPECT_GT(samples, 10000u);
}

TEST(Raster, NeighbouringTrianglesShareNoSampleAndLeaveNoGap) {
    std::vector<int> hits(64 * 64);
    const std::array<Vec2f, 4> corner{Vec2f(4, 4), Vec2f(60, 4), Vec2f(60, 60), Vec2f(4, 60)};
    const auto count = [&](int x, int y, const Vec3f&) { ++hits[static_cast<std::size_t>(64 * y + x)]; };
    forSamplesOfTriangle(corner[0], corner[1], corner[2], 64, 64, count);
    forSamplesOfTriangle(corner[0], corner[2], corner[3], 64, 64, count);
    int missing = 0;
    for (int y = 5; y < 59; ++y)
        for (int x = 5; x < 59; ++x) missing += hits[static_cast<std::size_t>(64 * y + x)] == 0 ? 1 : 0;
    EXPECT_EQ(missing, 0);
}

struct Baked {
    Hair hair;
    Strip strip;
    Picture picture;
};
/// `lean` is by how much of their length hairs go aside at most, each by a length of its own.
Baked bakedRibbon(std::uint32_t strands, float thickness = 1, float lean = 0) {
    Baked baked{ribbonHair(strands, 0.04f, 0.002f), {}, {}};
    for (std::uint32_t s = 0; s < strands; ++s) {
        const float slope = Random(5, s).uniform(-lean, lean);
        for (std::uint32_t p = baked.hair.offsets[s]; p < baked.hair.offsets[s + 1]; ++p)
            baked.hair.positions_ws[p].x() += slope * baked.hair.positions_ws[p].y();
    }
    const auto light = HairLight::make(baked.hair, nullptr);
    const EvenHair even = evenHair(baked.hair, 25);
    std::vector<std::uint32_t> all(strands);
    std::iota(all.begin(), all.end(), 0u);
    baked.strip =
        finishStrip(even, all, fitStrip(even, all, baked.hair.rootNormals_ws), 25, baked.hair.rootNormals_ws);
    baked.picture = bake(baked.hair, *light, baked.strip, all, {.thickness = thickness}, 64, 128);
    return baked;
}

double meanCoverage(const Picture& picture) {
    double sum = 0;
    for (const Texel& t : picture.texels) sum += static_cast<double>(t.coverage);
    return sum / static_cast<double>(picture.texels.size());
}

TEST(Bake, CoversWhatRandomStrandsOfThatAreaDo) {
    const Baked baked = bakedRibbon(80);
    // 80 strands of 0.4 mm on 40 mm, here and there one over another.
    EXPECT_NEAR(meanCoverage(baked.picture), 1 - std::exp(-80 * 0.0004 / 0.04), 0.04);
    EXPECT_GT(meanCoverage(bakedRibbon(80, 2).picture), meanCoverage(baked.picture) + 0.1);
}

TEST(Bake, FlowGoesDownTheCardAndRootsComeFirst) {
    const Baked baked = bakedRibbon(80);
    double along = 0, weight = 0, top = 0, bottom = 0, topWeight = 0, bottomWeight = 0;
    for (std::uint32_t y = 0; y < 128; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            const Texel& t = baked.picture.at(x, y);
            const auto c = static_cast<double>(t.coverage);
            along += c * static_cast<double>(t.flow.y()), weight += c;
            (y < 64 ? top : bottom) += c * static_cast<double>(t.along);
            (y < 64 ? topWeight : bottomWeight) += c;
        }
    }
    EXPECT_GT(along / weight, 0.99);
    EXPECT_NEAR(top / topWeight, 0.25, 0.05);
    EXPECT_NEAR(bottom / bottomWeight, 0.75, 0.05);
}

/// Mean coverage of the rows between two distances from the root.
double coverageBetween(const Baked& baked, const Picture& picture, float from, float to) {
    double sum = 0, count = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        const float way =
            (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height) * baked.strip.length() -
            baked.strip.centre[0].y();
        if (way < from || way > to) continue;
        for (std::uint32_t x = 0; x < picture.width; ++x)
            sum += static_cast<double>(picture.at(x, y).coverage), ++count;
    }
    return count > 0 ? sum / count : -1;
}

TEST(Bake, LeavesHairThatLiesOnTheSkinToTheCap) {
    Baked baked = bakedRibbon(300);
    const auto light = HairLight::make(baked.hair, nullptr);
    std::vector<std::uint32_t> all(baked.hair.strandCount());
    std::iota(all.begin(), all.end(), 0u);
    const auto cleared = [&] {
        return bake(baked.hair, *light, baked.strip, all, {.clear = 0.0025f}, 64, 256);
    };
    const Picture whole = bake(baked.hair, *light, baked.strip, all, {}, 64, 256);
    // They run along the skin, all of them: the cap has the first 12 mm, of some a little less.
    EXPECT_GT(coverageBetween(baked, whole, 0.001f, 0.006f), 0.1);
    EXPECT_EQ(coverageBetween(baked, cleared(), 0, 0.006f), 0);
    EXPECT_NEAR(coverageBetween(baked, cleared(), 0.013f, 0.1f), coverageBetween(baked, whole, 0.013f, 0.1f),
                1e-3);
    // Out of a skin that they stand upright on, they are soon clear of it.
    for (Vec3f& normal : baked.hair.rootNormals_ws) normal = Vec3f(0, -1, 0);
    EXPECT_EQ(coverageBetween(baked, cleared(), 0, 0.001f), 0);
    EXPECT_NEAR(coverageBetween(baked, cleared(), 0.004f, 0.1f), coverageBetween(baked, whole, 0.004f, 0.1f),
                1e-3);
}

TEST(Atlas, PacksWithoutOverlapOrNotAtAll) {
    const std::vector<std::array<std::uint32_t, 2>> sizes{{20, 60}, {30, 50}, {10, 10}, {40, 60}, {25, 25}};
    const auto rects = packed(sizes, 128, 4);
    ASSERT_EQ(rects.size(), sizes.size());
    std::vector<int> used(128 * 128);
    for (std::size_t i = 0; i < rects.size(); ++i) {
        EXPECT_EQ(rects[i].width, sizes[i][0]);
        EXPECT_EQ(rects[i].height, sizes[i][1]);
        for (std::uint32_t y = rects[i].y - 4; y < rects[i].y + rects[i].height + 4; ++y)
            for (std::uint32_t x = rects[i].x - 4; x < rects[i].x + rects[i].width + 4; ++x)
                EXPECT_EQ(used[128 * y + x]++, 0);
    }
    EXPECT_TRUE(packed(sizes, 64, 4).empty());
}

TEST(Atlas, PacksSmallPicturesBesideTallOnes) {
    std::vector<std::array<std::uint32_t, 2>> sizes{{40, 124}};
    for (int i = 0; i < 16; ++i) sizes.push_back({16, 26});  // four rows of four
    EXPECT_EQ(packed(sizes, 128, 2).size(), sizes.size());
}

TEST(Atlas, CoverageAloneIsThatOfWholeTexels) {
    Baked baked = bakedRibbon(80);
    const Rect rect{4, 6, 64, 128};
    const Atlas atlas = makeAtlas({baked.picture}, {rect}, 256);
    for (const std::size_t level : {0u, 1u, 4u, 8u}) {
        const CoverageSampler sampler(atlas, rect, level);
        for (int v = 0; v <= 40; ++v) {
            for (int u = 0; u <= 40; ++u) {
                const Vec2f at(static_cast<float>(u) / 40, static_cast<float>(v) / 40);
                const float coverage = sampler.at(at.x(), at.y());
                ASSERT_EQ(coverage, sample(atlas, rect, level, at.x(), at.y()).coverage);
                ASSERT_LE(coverage, sampler.most(at, at));
                ASSERT_LE(coverage, sampler.most(Vec2f(0.5f * at.x(), 0), Vec2f(1, at.y())));
            }
        }
    }
}

TEST(Atlas, MipMapsKeepCoverage) {
    // Parallel hairs would cover whole columns alike: of so few values none parts texels in a given share.
    Baked baked = bakedRibbon(80, 1, 0.1f);
    std::vector<Picture> pictures{baked.picture};
    const Atlas atlas = makeAtlas(std::move(pictures), {Rect{4, 4, 64, 128}}, 256);
    const double inAtlas = meanCoverage(atlas.levels[0]);
    const auto above = [&](const Picture& picture, float scale) {
        std::size_t count = 0;
        for (const Texel& t : picture.texels)
            count += scale * t.coverage >= atlas.threshold * 0.9999f ? 1 : 0;
        return static_cast<double>(count) / static_cast<double>(picture.texels.size());
    };
    const double share = above(atlas.levels[0], 1);
    EXPECT_NEAR(share, inAtlas, 0.02) << "a mask covers what alpha does, as far as steps of alpha let it";
    for (std::size_t level = 1; level + 4 < atlas.levels.size(); ++level) {
        EXPECT_NEAR(meanCoverage(atlas.levels[level]), inAtlas, 1e-4) << level;
        EXPECT_NEAR(above(atlas.levels[level], keepingScale(atlas, level)), share, 0.15 * share + 0.004)
            << level;
    }
}

TEST(Atlas, GapsTakeTheColoursOfWhatIsNear) {
    Baked baked = bakedRibbon(10);
    std::vector<Picture> pictures{baked.picture};
    const Atlas atlas = makeAtlas(std::move(pictures), {Rect{4, 4, 64, 128}}, 256);
    for (const Texel& t : atlas.levels[0].texels) EXPECT_NEAR(t.albedo.x(), 0.3f, 0.01f);
}

}  // namespace
}  // namespace hairloom::cards
