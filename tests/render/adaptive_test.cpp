// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive shadow maps against the whole list of what stands in a texel's light, kept in double precision.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/random.h"
#include "core/render/shadow_truth.h"
#include "core/software/device.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// Sheets of fibres side by side under a light from above: each texel has one of each sheet.
struct Sheets {
    std::vector<double> depths;  ///< below the first, metres, ascending
    float opacity = 1;           ///< share of a fibre that each counts
    TestStrands strands;
    RenderScene scene;

    Sheets(std::vector<double> at, float share, bool backwards = false)
        : depths(std::move(at)), opacity(share) {
        for (std::size_t s = 0; s < depths.size(); ++s) {
            const std::size_t sheet = backwards ? depths.size() - 1 - s : s;
            for (int i = 0; i < 50; ++i) {
                const float z = 0.001f + 0.002f * static_cast<float>(i),
                            y = -static_cast<float>(depths[sheet]);
                strands.add({Vec3f(0.001f, y, z), Vec3f(0.099f, y, z)}, 0.001f);
            }
        }
        scene.strands = {strands.view()};
        scene.strands[0].material.rootOpacity = scene.strands[0].material.tipOpacity = opacity;
        Light light;
        light.toLight_ws = Vec3f::UnitY();
        scene.lights = {light};
    }
    /// Light that the sheets in front of a depth leave.
    double light(double depth) const {
        const auto before = std::ranges::lower_bound(depths, depth) - depths.begin();
        return std::exp(-0.5 * static_cast<double>(opacity) * static_cast<double>(before));
    }
};

RenderOptions nodes(std::uint32_t count) {
    RenderOptions options;
    options.shadows = Shadows::adaptive;
    options.shadowNodes = count;
    options.shadowResolution = 64;
    options.shadowFilter = ShadowFilter::off;
    options.subdivisions = 1;
    return options;
}

/// n depths in 0 … 8 cm, at least 0.4 mm apart, nearer to each other in places.
std::vector<double> unevenDepths(std::size_t n) {
    Random random(11);
    std::vector<double> depths{0};
    double sum = 0;
    for (std::size_t i = 1; i < n; ++i) {
        const double u = static_cast<double>(random.uniform());
        sum += 0.2 + u * u * u * u * 4;
        depths.push_back(sum);
    }
    for (double& depth : depths) depth = depth / sum * 0.08;
    return depths;
}

/// Of |ours − exact| over the depth of the sheets, with the line through that many of the exact curve's
/// corners: the least of all choices, by dynamic programming.
double leastArea(const Sheets& sheets, std::size_t nodes) {
    struct Corner {
        double depth, light;
    };
    std::vector<Corner> corners;
    for (std::size_t s = 0; s < sheets.depths.size(); ++s) {
        for (const std::size_t before : {s, s + 1})
            corners.push_back({sheets.depths[s], std::exp(-0.5 * static_cast<double>(sheets.opacity) *
                                                          static_cast<double>(before))});
    }
    constexpr int kSteps = 8;  // of an integral over the depth between two sheets
    const auto area = [&](std::size_t a, std::size_t b) {
        const Corner &from = corners[a], &to = corners[b];
        double sum = 0;
        for (std::size_t c = a; c < b; ++c) {
            const double width = corners[c + 1].depth - corners[c].depth;
            for (int k = 0; k < kSteps && width > 0; ++k) {
                const double depth = corners[c].depth + (k + 0.5) / kSteps * width;
                const double line =
                    from.light + (to.light - from.light) * (depth - from.depth) / (to.depth - from.depth);
                sum += std::abs(line - corners[c].light) * width / kSteps;
            }
        }
        return sum;
    };
    std::vector<double> best(corners.size(), std::numeric_limits<double>::infinity());
    best[0] = 0;
    for (std::size_t n = 1; n < nodes; ++n) {
        std::vector<double> next = best;
        for (std::size_t b = 1; b < corners.size(); ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                if (std::isfinite(best[a])) next[b] = std::min(next[b], best[a] + area(a, b));
            }
        }
        best = next;
    }
    return best.back();
}

class AdaptiveTest : public RenderTest {
  protected:
    /// Light at depths under the first sheet, from the fibres that the map has in front of them.
    std::vector<double> lightAt(gpu::Device& on, const Sheets& sheets, const std::vector<double>& depths,
                                const RenderOptions& options) {
        std::vector<shaders::LightCase> cases;
        for (const double depth : depths)
            cases.push_back({{0.0503f, -static_cast<float>(depth), 0.0503f, 0}, {0, 0, 0, 0}});
        const auto found = probeLight(on, sheets.scene, options, cases);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        std::vector<double> light;
        if (found)
            for (const shaders::LightAnswer& answer : *found)
                light.push_back(std::exp(-0.5 * static_cast<double>(answer.onHair.w)));
        light.resize(depths.size());
        return light;
    }
    /// Of |ours − exact| over the sheets' depth.
    double area(const Sheets& sheets, const RenderOptions& options) {
        constexpr std::size_t kSteps = 2000;
        std::vector<double> depths;
        for (std::size_t i = 0; i < kSteps; ++i)
            depths.push_back((static_cast<double>(i) + 0.5) / kSteps * sheets.depths.back());
        const std::vector<double> light = lightAt(*device, sheets, depths, options);
        double sum = 0;
        for (std::size_t i = 0; i < kSteps; ++i) sum += std::abs(light[i] - sheets.light(depths[i]));
        return sum * sheets.depths.back() / kSteps;
    }
};

// A step takes two nodes. What is off is the rounding of a node to 16 bits of depth and of fibres.
TEST_F(AdaptiveTest, IsExactWhileThereAreNodesForEachStep) {
    const std::pair<std::size_t, std::uint32_t> cases[] = {{1, 4}, {2, 4}, {4, 8}, {8, 16}, {1, 16}};
    for (const auto& [count, held] : cases) {
        const Sheets sheets(unevenDepths(count), 0.6f);
        std::vector<double> depths{-0.001};
        for (std::size_t i = 0; i < count; ++i) {
            const double next = i + 1 < count ? sheets.depths[i + 1] : sheets.depths[i] + 0.004;
            for (const double part : {0.05, 0.5, 0.95})
                depths.push_back(sheets.depths[i] + part * (next - sheets.depths[i]));
        }
        const std::vector<double> light = lightAt(*device, sheets, depths, nodes(held));
        for (std::size_t i = 0; i < depths.size(); ++i)
            EXPECT_NEAR(light[i], sheets.light(depths[i]), 5e-4) << count << " sheets, " << depths[i] << " m";
    }
}

TEST_F(AdaptiveTest, IsNearTheBestChoiceOfNodes) {
    const Sheets sheets(unevenDepths(40), 0.15f);
    double before = std::numeric_limits<double>::infinity();
    for (const std::uint32_t count : {4u, 8u, 16u}) {
        const double found = area(sheets, nodes(count));
        const double least = leastArea(sheets, count);
        // Nodes that are gone do not come back: over such lists 1.5 times the least is usual.
        EXPECT_LT(found, 3 * least + 1e-5) << count;
        EXPECT_GT(found, 0.98 * least - 1e-6) << count << ": better than the best";
        EXPECT_LT(found, 0.9 * before) << count;
        before = found;
    }
    const std::vector<double> behind = lightAt(*device, sheets, {-0.01, 0.09}, nodes(4));
    EXPECT_EQ(behind[0], 1);
    EXPECT_NEAR(behind[1], sheets.light(0.09), 2e-4) << "all hair is counted, however few the nodes";
}

TEST_F(AdaptiveTest, HasTheSameBitsInAnyOrderOfStrandsAndThreads) {
    const std::vector<double> depths = unevenDepths(30);
    const Sheets forwards(depths, 0.2f), backwards(depths, 0.2f, true);
    const auto first = readNodes(*device, forwards.scene, nodes(8));
    ASSERT_TRUE(first) << first.error().message();
    EXPECT_EQ(first->listed, first->found);
    EXPECT_GT(first->found, 30u * 50u * 50u);
    for (int i = 0; i < 3; ++i) {
        const auto again = readNodes(*device, backwards.scene, nodes(8));
        ASSERT_TRUE(again) << again.error().message();
        EXPECT_EQ(again->words, first->words);
    }
    for (std::size_t texel = 0; texel < first->words.size(); texel += 8) {
        for (std::size_t i = 1; i < 8; ++i) {
            EXPECT_GE(first->words[texel + i] >> 16, first->words[texel + i - 1] >> 16);
            EXPECT_GE(first->words[texel + i] & 0xffffu, first->words[texel + i - 1] & 0xffffu);
        }
    }
}

TEST_F(AdaptiveTest, TheSoftwareRendererHasTheSameNodes) {
    const Sheets sheets(unevenDepths(20), 0.3f);
    const auto processor = software::makeDevice();
    const auto here = readNodes(*processor, sheets.scene, nodes(8));
    const auto there = readNodes(*device, sheets.scene, nodes(8));
    ASSERT_TRUE(here && there);
    ASSERT_EQ(here->words.size(), there->words.size());
    std::size_t differ = 0;  // at the ends of hairs, where one of them has a pixel more
    for (std::size_t i = 0; i < here->words.size(); ++i) {
        const auto depth = [i](const NodeTexels& of) { return static_cast<int>(of.words[i] >> 16); };
        const auto fibres = [i](const NodeTexels& of) { return static_cast<int>(of.words[i] & 0xffffu); };
        differ += std::abs(depth(*here) - depth(*there)) > 1 || std::abs(fibres(*here) - fibres(*there)) > 1;
    }
    EXPECT_LT(differ, here->words.size() / 50);
    EXPECT_GT(here->found, 20u * 50u * 50u);
}

/// The mean of fibres behind all sheets.
double meanFibres(const NodeTexels& texels) {
    double sum = 0, count = 0;
    for (std::size_t last = texels.nodes - 1; last < texels.words.size(); last += texels.nodes) {
        const std::uint32_t fibres = texels.words[last] & 0xffffu;
        sum += 64.0 * fibres / 65535;
        count += 1;
    }
    return sum / count;
}

TEST_F(AdaptiveTest, ListsThatAreFullTakeAPartForTheWholeAndSaySo) {
    const Sheets sheets(unevenDepths(60), 0.2f);
    RenderOptions options = nodes(8);
    const auto all = readNodes(*device, sheets.scene, options);
    ASSERT_TRUE(all) << all.error().message();
    options.shadowFragments = kMinShadowFragments;
    const auto full = readNodes(*device, sheets.scene, options);
    ASSERT_TRUE(full) << full.error().message();
    ASSERT_GT(full->found, 2 * kMinShadowFragments);
    EXPECT_EQ(full->found, all->found);
    EXPECT_LE(full->listed, kMinShadowFragments);
    EXPECT_GT(full->listed, kMinShadowFragments / 10 * 9);
    EXPECT_NEAR(meanFibres(*full), meanFibres(*all), 0.01 * meanFibres(*all));
    const auto again = readNodes(*device, sheets.scene, options);
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_EQ(again->words, full->words) << "which are taken does not depend on threads";
    RenderScene scene = sheets.scene;
    scene.camera.eye_ws = {0.05f, 0.3f, 0.3f};
    scene.camera.target_ws = {0.05f, 0, 0.05f};
    options.width = options.height = 16;
    options.frames = 1;
    const auto why = [&] {
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? picture->plan.passes[static_cast<std::size_t>(Pass::opacity)].why : "";
    };
    EXPECT_NE(why().find("are more than the 65536 that lists hold"), std::string::npos) << why();
    options.shadowFragments = kMaxShadowFragments;
    EXPECT_EQ(why().find("lists hold"), std::string::npos) << why();
}

/// Strands one above the other over 8 cm, and a sheet that makes the light's view wider.
struct Column {
    TestStrands strands;
    RenderScene scene;

    Column(std::uint32_t count, float opacity) {
        const Sheets sheet({0}, opacity);
        strands = sheet.strands;
        scene = sheet.scene;
        for (std::uint32_t i = 0; i < count; ++i) {
            const float y = -0.08f * static_cast<float>(i + 1) / static_cast<float>(count);
            strands.add({Vec3f(0.001f, y, 0.049f), Vec3f(0.099f, y, 0.049f)}, 0.001f);
        }
        const auto material = scene.strands[0].material;
        scene.strands = {strands.view()};
        scene.strands[0].material = material;
    }
};

/// All that each texel has.
std::vector<double> fibresOf(const NodeTexels& texels) {
    std::vector<double> fibres;
    for (std::size_t last = texels.nodes - 1; last < texels.words.size(); last += texels.nodes)
        fibres.push_back(64.0 * (texels.words[last] & 0xffffu) / 65535);
    return fibres;
}

/// One thread sorts a list, so that no texel's grows without end. As many fibres in half as many strands,
/// each of twice the opacity, fit.
TEST_F(AdaptiveTest, ATexelsListIsBoundedAndThePlanSaysSo) {
    const Column half(2000, 0.004f), all(4000, 0.002f);
    std::vector<double> sums;
    const auto processor = software::makeDevice();
    for (gpu::Device* const on : {device.get(), processor.get()}) {
        const auto whole = readNodes(*on, half.scene, nodes(8)), part = readNodes(*on, all.scene, nodes(8));
        ASSERT_TRUE(whole && part);
        EXPECT_EQ(whole->listed, whole->found);
        const std::vector<double> expected = fibresOf(*whole), found = fibresOf(*part);
        ASSERT_EQ(found.size(), expected.size());
        double sum = 0, sumExpected = 0;
        std::size_t full = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (expected[i] < 4) continue;
            ++full;
            EXPECT_NEAR(found[i], expected[i], 0.08 * expected[i]);
            sum += found[i];
            sumExpected += expected[i];
        }
        ASSERT_GE(full, 50u);
        EXPECT_LT(part->listed, part->found - full * 1900);
        EXPECT_GT(part->listed, full * 1800);
        EXPECT_NEAR(sum, sumExpected, 0.01 * sumExpected);
        sums.push_back(sumExpected);
        const auto again = readNodes(*on, all.scene, nodes(8));
        ASSERT_TRUE(again) << again.error().message();
        EXPECT_EQ(again->words, part->words) << "which are taken does not depend on threads";
    }
    EXPECT_NEAR(sums[0], sums[1], 0.01 * sums[1]) << "a long list is sorted whole on every device";
    RenderScene scene = all.scene;
    scene.camera.eye_ws = {0.05f, 0.3f, 0.3f};
    scene.camera.target_ws = {0.05f, 0, 0.05f};
    RenderOptions options = nodes(8);
    options.width = options.height = 16;
    options.frames = 1;
    const auto picture = renderPicture(*device, scene, options);
    ASSERT_TRUE(picture) << picture.error().message();
    const std::string why = picture->plan.passes[static_cast<std::size_t>(Pass::opacity)].why;
    EXPECT_NE(why.find("2048 pieces that a list holds"), std::string::npos) << why;
}

// As the other kinds of shadows, over hair combed down from a crown.
TEST_F(AdaptiveTest, IsNearerToCountedFibresThanThreeLayersOrFourSlices) {
    const TestHead head(1500);
    RenderScene scene = head.scene();
    scene.meshes.clear();
    Light light;
    light.toLight_ws = Vec3f(0.4f, 0.8f, 0.45f);
    scene.lights = {light};
    const ShadowCases cases = countFibres(scene, 600, 8);
    const auto error = [&](Shadows kind, std::uint32_t count) {
        RenderOptions options;
        options.shadows = kind;
        options.shadowNodes = count;
        options.shadowResolution = 128;
        const auto found = shadowError(*device, scene, cases, options);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        return found.value_or(1);
    };
    const double four = error(Shadows::adaptive, 4), eight = error(Shadows::adaptive, 8),
                 sixteen = error(Shadows::adaptive, 16);
    // More nodes no longer matter: what is left is that a texel is not a beam of 5 mm.
    EXPECT_NEAR(four, eight, 0.1 * eight);
    EXPECT_NEAR(sixteen, eight, 0.05 * eight);
    EXPECT_LT(eight, error(Shadows::deepOpacity, 8));
    EXPECT_LT(eight, error(Shadows::opacityMaps, 8));
}

}  // namespace
}  // namespace hairloom::render
