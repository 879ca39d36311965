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
        const auto found = shadowError(*device, scene, cases, kind, 256);
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
        const auto found = shadowError(*device, scene, cases, Shadows::deepOpacity, 512, kDeepLayers, filter);
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
