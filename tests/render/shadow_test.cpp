// SPDX-License-Identifier: GPL-3.0-or-later
// Light that reaches points inside hair, against fibres counted on the CPU.
#include "core/render/shadow_truth.h"

#include <cmath>
#include <numeric>

#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// A row of fibres across the light, one behind the other, wider than the beam.
TEST(CountedFibres, AreThoseInTheWay) {
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
    for (std::size_t i = 0; i < cases.counted.size(); ++i) {
        const double above = 4 - std::round(static_cast<double>(cases.cases[i].position_ws.y) / 0.01);
        const bool atEnd = std::abs(cases.cases[i].position_ws.x) > 0.099f;
        // Points lie at the ends of the fibres, where half of the disc is covered.
        EXPECT_NEAR(cases.counted[i], above * one * (atEnd ? 0.5 : 1), 1e-3) << i;
    }
}

class ShadowTest : public RenderTest {};

TEST_F(ShadowTest, TransmittanceAgreesWithCountedFibres) {
    const TestHead head(1500);
    RenderScene scene = head.scene();
    scene.meshes.clear();
    Light light;
    light.toLight_ws = Vec3f(0.4f, 0.8f, 0.45f);
    scene.lights = {light};
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

}  // namespace
}  // namespace hairloom::render
