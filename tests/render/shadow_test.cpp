// SPDX-License-Identifier: GPL-3.0-or-later
// Light that reaches points inside hair, against fibres counted on the CPU.
#include "core/render/shadow_truth.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// A row of fibres across the light, one behind the other, wider than the beam.
TEST(CountedFibres, AreThoseBetweenTwoPoints) {
    TestStrands strands;
    const float radius = 0.0003f;
    for (int i = 0; i < 5; ++i) {
        const float y = 0.01f * static_cast<float>(i);
        strands.add({Vec3f(-0.1f, y, 0), Vec3f(0.1f, y, 0)}, radius);
    }
    RenderScene scene;
    scene.strands = {strands.view()};
    Light light;
    light.toLight_ws = Vec3f::UnitY();
    scene.lights = {light};
    // A fibre through the middle of a disc covers 2 r times the diameter of it.
    const double footprint = kShadowFootprint;
    const double one = 2 * 0.0003 * 2 * footprint / (3.14159265358979 * footprint * footprint);
    const ShadowCases cases = countFibres(scene, 40, 3);
    ASSERT_EQ(cases.counted.size(), 40u);
    for (std::size_t i = 0; i < cases.counted.size(); ++i) {
        const double above = 4 - std::round(static_cast<double>(cases.cases[i].position_ws.y) / 0.01);
        const bool atEnd = std::abs(cases.cases[i].position_ws.x) > 0.099f;
        // Points lie at the ends of the fibres, where half of the disc is covered.
        EXPECT_NEAR(cases.counted[i], above * one * (atEnd ? 0.5 : 1), 1e-3) << i;
    }
}

class ShadowTest : public RenderTest {};

/// The hair of a head alone.
RenderScene underOneLamp(const TestHead& head) {
    RenderScene scene = head.scene();
    scene.meshes.clear();
    Light light;
    light.toLight_ws = Vec3f(0.4f, 0.8f, 0.45f);
    scene.lights = {light};
    return scene;
}

TEST_F(ShadowTest, TransmittanceAgreesWithCountedFibres) {
    const TestHead head(1500);
    const RenderScene scene = underOneLamp(head);
    const ShadowCases cases = countFibres(scene, 600, 8);
    const double mean = std::accumulate(cases.counted.begin(), cases.counted.end(), 0.0) / 600;
    EXPECT_GT(mean, 0.7);
    const auto error = [&](Shadows kind) {
        RenderOptions options;
        options.shadows = kind;
        options.shadowResolution = 256;
        const auto found = shadowError(*device, scene, cases, options);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        return found.value_or(1);
    };
    const double deep = error(Shadows::deepOpacity);
    const double maps = error(Shadows::opacityMaps);
    const double absorption = error(Shadows::absorption);
    EXPECT_LT(deep, 0.12);
    EXPECT_LT(deep, maps);
    EXPECT_LT(maps, absorption);
    EXPECT_LT(absorption, 0.3);
}

/// Against counted fibres: the more layers there are, the nearer.
TEST_F(ShadowTest, MoreLayersAndSlicesFollowHairMoreClosely) {
    const TestHead head(1500);
    const RenderScene scene = underOneLamp(head);
    const ShadowCases cases = countFibres(scene, 600, 8);
    const auto error = [&](Shadows kind, std::uint32_t layers, LayerEnds ends = LayerEnds::linear) {
        RenderOptions options;
        options.shadows = kind;
        options.shadowResolution = 256;
        options.layerEnds = ends;
        (kind == Shadows::deepOpacity ? options.shadowLayers : options.shadowSlices) = layers;
        const auto found = shadowError(*device, scene, cases, options);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        return found.value_or(1);
    };
    const double three = error(Shadows::deepOpacity, 3), seven = error(Shadows::deepOpacity, 7),
                 eleven = error(Shadows::deepOpacity, 11);
    EXPECT_LT(seven, three);
    EXPECT_LT(eleven, 1.02 * seven);
    EXPECT_LT(error(Shadows::deepOpacity, 3, LayerEnds::growing), three) << "hair is dense where it begins";
    const double four = error(Shadows::opacityMaps, 4), sixteen = error(Shadows::opacityMaps, 16);
    EXPECT_LT(sixteen, four);
    EXPECT_LT(four, error(Shadows::opacityMaps, 1));
}

/// A sheet of hair across the light, and a point at each depth under it.
struct Sheet {
    TestStrands strands;
    RenderScene scene;

    Sheet() {
        for (int i = 0; i < 100; ++i) {
            const float z = 0.0005f + 0.001f * static_cast<float>(i);
            strands.add({Vec3f(0.001f, 0.004f, z), Vec3f(0.099f, 0.004f, z)}, 0.0006f);
        }
        scene.strands = {strands.view()};
        Light light;
        light.toLight_ws = Vec3f::UnitY();
        scene.lights = {light};
    }
    static std::vector<shaders::LightCase> under(const std::vector<float>& depths) {
        std::vector<shaders::LightCase> cases;
        for (const float depth : depths) cases.push_back({{0.05f, 0.004f - depth, 0.05f, 0}, {0, 1, 0, 0}});
        return cases;
    }
};

TEST_F(ShadowTest, AbsorptionByDepthIsThatOfEvenlySpreadHair) {
    Sheet sheet;
    RenderOptions options;
    options.shadows = Shadows::absorption;
    options.shadowResolution = 64;
    options.subdivisions = 1;
    const std::vector<float> depths{0.0f, 0.001f, 0.003f, 0.01f, 0.03f, 0.1f, 0.5f};
    const auto found = probeLight(*device, sheet.scene, options, Sheet::under(depths));
    ASSERT_TRUE(found) << found.error().message();
    // 100 hairs of one segment, measured in cells of 1 cm: the middles of all lie in ten.
    const double surface = 100 * 0.098 * 0.0012;
    const double crossed = surface * 3.14159265358979 / 4;
    const double perMetre = crossed / (10 * 1e-6);
    const double through = crossed / ((10 + 10 + 1) * 1e-4 / 3);
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double expected =
            through * (1 - std::exp(-static_cast<double>(depths[i]) * perMetre / through));
        EXPECT_NEAR(static_cast<double>((*found)[i].onHair.w), expected, 0.01 * through) << depths[i];
    }
}

TEST_F(ShadowTest, LightBehindTheHeadFadesWithDepth) {
    Sheet sheet;
    // Level above one half of the hair, rising by a fifth above the other.
    const std::vector<Vec3f> corners{{-0.1f, 0.02f, -0.1f}, {0.05f, 0.02f, -0.1f}, {0.05f, 0.02f, 0.2f},
                                     {-0.1f, 0.02f, 0.2f},  {0.25f, 0.06f, -0.1f}, {0.25f, 0.06f, 0.2f}};
    const std::vector<std::uint32_t> indices{0, 2, 1, 0, 3, 2, 1, 5, 4, 1, 2, 5};
    RenderMesh mesh;
    mesh.positions_ws = corners;
    mesh.indices = indices;
    sheet.scene.meshes = {mesh};
    constexpr float kBias = 0.002f;  // of the shader, metres
    for (const float absorption : {0.0f, 30.0f, 200.0f}) {
        RenderOptions options;
        options.shadows = Shadows::absorption;
        options.shadowResolution = 128;
        options.headAbsorption = absorption;
        std::vector<shaders::LightCase> cases;
        std::vector<float> behind;
        for (const float x : {0.02f, 0.08f}) {
            const float top = x < 0.05f ? 0.02f : 0.02f + 0.2f * (x - 0.05f);
            for (const float depth : {-0.01f, 0.0f, 0.004f, 0.01f, 0.03f}) {
                behind.push_back(depth - kBias);
                cases.push_back({{x, top - depth, 0.05f, 0}, {0, 1, 0, 0}});
            }
        }
        const auto found = probeLight(*device, sheet.scene, options, cases);
        ASSERT_TRUE(found) << found.error().message();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const float expected = absorption > 0 ? std::exp(-absorption * std::max(behind[i], 0.0f))
                                                  : (behind[i] < 0 ? 1.0f : 0.0f);
            // A texel of 0.8 mm sees the slope 0.16 mm higher at one side than at the other.
            EXPECT_NEAR((*found)[i].onSkin.w, expected, 0.02f) << absorption << ", " << behind[i] << " m";
        }
    }
}

/// Sheets of fibres one behind the other, with points between them: every way of cutting their depth into
/// layers counts all sheets behind the last, and none before the first.
TEST_F(ShadowTest, AnyNumberOfLayersCountsTheSameFibres) {
    TestStrands strands;
    constexpr int kSheets = 24;
    for (int sheet = 0; sheet < kSheets; ++sheet) {
        for (int i = 0; i < 100; ++i) {
            const float z = 0.0005f + 0.001f * static_cast<float>(i), y = -0.002f * static_cast<float>(sheet);
            strands.add({Vec3f(0.001f, y, z), Vec3f(0.099f, y, z)}, 0.0006f);
        }
    }
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.environment = Environment::gradient(Vec3f::Zero(), Vec3f::Zero());  // maps of the sky are not asked
    Light light;
    light.toLight_ws = Vec3f::UnitY();
    scene.lights = {light};
    std::vector<shaders::LightCase> cases;
    for (int sheet = 0; sheet <= kSheets; ++sheet)
        cases.push_back({{0.05f, 0.001f - 0.002f * static_cast<float>(sheet), 0.05f, 0}, {0, 1, 0, 0}});
    const auto fibres = [&](const RenderOptions& options) {
        const auto found = probeLight(*device, scene, options, cases);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        std::vector<double> all;
        if (found)
            for (const auto& answer : *found) all.push_back(static_cast<double>(answer.onHair.w));
        return all;
    };
    RenderOptions options;
    options.subdivisions = 1;
    options.shadowResolution = 128;
    const double whole = fibres(options).back();
    EXPECT_GT(whole, 0.5 * kSheets);
    const auto follows = [&](const char* what, double tolerance) {
        const std::vector<double> counted = fibres(options);
        ASSERT_EQ(counted.size(), cases.size());
        EXPECT_NEAR(counted.front(), 0, 1e-3) << what;
        EXPECT_NEAR(counted.back(), whole, 0.01 * whole) << what;
        for (std::size_t i = 1; i < counted.size(); ++i) {
            EXPECT_GE(counted[i], counted[i - 1] - 1e-4) << what << i;
            EXPECT_NEAR(counted[i], whole * static_cast<double>(i) / kSheets, tolerance * whole) << what << i;
        }
    };
    for (const std::uint32_t layers : {3u, 4u, 5u, 7u, 8u, 11u}) {
        options.shadowLayers = layers;
        for (const LayerEnds ends : {LayerEnds::early, LayerEnds::linear, LayerEnds::growing}) {
            options.layerEnds = ends;
            follows(("layers " + std::to_string(layers)).c_str(), 0.07);
        }
    }
    options.shadows = Shadows::opacityMaps;
    for (const std::uint32_t slices : {1u, 2u, 3u, 4u, 5u, 9u, 16u}) {
        options.shadowSlices = slices;
        follows(("slices " + std::to_string(slices)).c_str(), 0.07);
    }
}

/// Under the straight edge of a shadow the light goes over as a B-spline's integral does: over n texels of a
/// map that holds a step, the change has the variance of n − 1 boxes of one texel, (n − 1)/12.
TEST_F(ShadowTest, FiltersSpreadAnEdgeOverTheirTexels) {
    Sheet sheet;
    const std::vector<Vec3f> corners{
        {-0.1f, 0.02f, -0.1f}, {0.05f, 0.02f, -0.1f}, {0.05f, 0.02f, 0.2f}, {-0.1f, 0.02f, 0.2f}};
    const std::vector<std::uint32_t> indices{0, 2, 1, 0, 3, 2};
    RenderMesh mesh;
    mesh.positions_ws = corners;
    mesh.indices = indices;
    sheet.scene.meshes = {mesh};
    struct Edge {
        double place = 0, variance = 0;  ///< metres, metres²
        std::size_t levels = 0;          ///< different values
    };
    const auto edge = [&](ShadowFilter filter) {
        RenderOptions options;
        options.shadows = Shadows::absorption;
        options.shadowResolution = 128;
        options.shadowFilter = filter;
        std::vector<shaders::LightCase> cases;
        for (int i = 0; i <= 400; ++i)
            cases.push_back({{0.045f + 0.000025f * static_cast<float>(i), 0.001f, 0.05f, 0}, {0, 1, 0, 0}});
        const auto found = probeLight(*device, sheet.scene, options, cases);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        Edge result;
        if (!found) return result;
        EXPECT_NEAR(found->front().onSkin.w, 0, 1e-5f);
        EXPECT_NEAR(found->back().onSkin.w, 1, 1e-5f);
        std::vector<float> levels;
        double square = 0;
        for (std::size_t i = 1; i < cases.size(); ++i) {
            const double x = 0.5 * static_cast<double>(cases[i].position_ws.x + cases[i - 1].position_ws.x);
            const double rise = static_cast<double>((*found)[i].onSkin.w - (*found)[i - 1].onSkin.w);
            EXPECT_GT(rise, -1e-5);
            result.place += rise * x;
            square += rise * x * x;
            levels.push_back((*found)[i].onSkin.w);
        }
        result.variance = square - result.place * result.place;
        std::ranges::sort(levels);
        result.levels = static_cast<std::size_t>(std::unique(levels.begin(), levels.end()) - levels.begin());
        return result;
    };
    const Edge off = edge(ShadowFilter::off), three = edge(ShadowFilter::three),
               five = edge(ShadowFilter::five);
    EXPECT_EQ(off.levels, 2u) << "the nearest texel lets light through or not";
    EXPECT_GT(three.levels, 20u);
    EXPECT_NEAR(five.variance / three.variance, 2, 0.1);
    // The map's texel follows from it, and is the hair's width over the map's.
    const double texel = std::sqrt(6 * three.variance);
    EXPECT_GT(texel, 0.098 / 128);
    EXPECT_LT(texel, 0.13 / 128);
    EXPECT_NEAR(three.place, five.place, 0.05 * texel);
    EXPECT_NEAR(three.place, off.place, 0.05 * texel);
    EXPECT_NEAR(three.place, 0.05, 0.6 * texel);
}

/// More texels bring light nearer to counted fibres, for texels much finer than the beams that are counted.
TEST_F(ShadowTest, FiltersBringFineMapsNearerToCountedFibres) {
    const TestHead head(1500);
    const RenderScene scene = underOneLamp(head);
    const ShadowCases cases = countFibres(scene, 400, 8);
    const auto error = [&](ShadowFilter filter) {
        RenderOptions options;
        options.shadowResolution = 512;
        options.shadowFilter = filter;
        const auto found = shadowError(*device, scene, cases, options);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        return found.value_or(1);
    };
    const double off = error(ShadowFilter::off), three = error(ShadowFilter::three),
                 five = error(ShadowFilter::five);
    EXPECT_LT(three, 0.95 * off);
    EXPECT_LT(five, three);
}

TEST_F(ShadowTest, RaysAgreeWithShadowOfTheHead) {
    const TestHead head(400);
    RenderScene scene = head.scene();
    Light light;
    light.toLight_ws = Vec3f(1, 0.3f, 0.2f);
    scene.lights = {light};
    const HeadCases cases = castRays(scene, 300, 5);
    const double visible = std::accumulate(cases.visible.begin(), cases.visible.end(), 0.0) / 300;
    EXPECT_GT(visible, 0.2);
    EXPECT_LT(visible, 0.9);
    const auto error = [&](float absorption) {
        const auto found = headShadowError(*device, scene, cases, absorption, 256);
        EXPECT_TRUE(found) << (found ? "" : found.error().message());
        return found.value_or(1);
    };
    const double faint = error(10);
    EXPECT_GT(faint, 0.2) << "nearly no shadow";
    EXPECT_LT(error(0), 0.7 * faint);
    EXPECT_LT(error(1000), 0.7 * faint);
}

}  // namespace
}  // namespace hairloom::render
