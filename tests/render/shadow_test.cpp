// SPDX-License-Identifier: GPL-3.0-or-later
// Light that reaches points inside hair, against fibres counted on the CPU.
#include <algorithm>
#include <cstdio>

#include "tests/render/light_fixture.h"

namespace hairloom::render {
namespace {

constexpr double kBias = 0.0007;       // metres, as the shading has it
constexpr double kFootprint = 0.0025;  // metres, radius of the beam around a point

/// Length of the part of a segment that lies inside a disc around the origin.
double insideDisc(const Vec2d& a, const Vec2d& b, double radius) {
    const Vec2d d = b - a;
    const double qa = d.squaredNorm(), qb = 2 * a.dot(d), qc = a.squaredNorm() - radius * radius;
    if (qa <= 0) return 0;
    const double discriminant = qb * qb - 4 * qa * qc;
    if (discriminant <= 0) return 0;
    const double root = std::sqrt(discriminant);
    const double t0 = std::clamp((-qb - root) / (2 * qa), 0.0, 1.0);
    const double t1 = std::clamp((-qb + root) / (2 * qa), 0.0, 1.0);
    return (t1 - t0) * std::sqrt(qa);
}

class ShadowTest : public LightTest {
  protected:
    ShadowTest() {
        toLight = Vec3d(0.4, 0.8, 0.45).normalized();
        right = Vec3d::UnitX().cross(toLight).normalized();
        up = toLight.cross(right);
        scene = head.scene();
        scene.meshes.clear();
        Light light;
        light.toLight_ws = toLight.cast<float>();
        scene.lights = {light};
        Random random(8);
        for (int i = 0; i < 600; ++i) {
            const auto p =
                head.strands
                    .positions[random.below(static_cast<std::uint32_t>(head.strands.positions.size()))];
            cases.push_back({toShader(p, static_cast<float>(kBias)), {0, 1, 0, 0}});
            counted.push_back(count(p.cast<double>()));
        }
    }

    /// Mean number of fibres that a beam from the light to the point crosses. Straight between the points, as
    /// with one subdivision.
    double count(const Vec3d& p) const {
        double area = 0;
        const auto& offsets = head.strands.offsets;
        for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
            for (std::uint32_t k = offsets[s]; k + 1 < offsets[s + 1]; ++k) {
                Vec3d a = head.strands.positions[k].cast<double>() - p;
                Vec3d b = head.strands.positions[k + 1].cast<double>() - p;
                double da = a.dot(toLight) - kBias, db = b.dot(toLight) - kBias;
                if (da <= 0 && db <= 0) continue;
                if (da < 0) a += (b - a) * (-da / (db - da));
                if (db < 0) b += (a - b) * (-db / (da - db));
                const Vec2d a2(a.dot(right), a.dot(up)), b2(b.dot(right), b.dot(up));
                area += insideDisc(a2, b2, kFootprint) * 2 * static_cast<double>(head.strands.radii[k]);
            }
        }
        return area / (static_cast<double>(kPi) * kFootprint * kFootprint);
    }

    /// Root of the mean square error of exp(-n / 2).
    double error(Shadows kind, std::uint32_t resolution, std::array<float, 3> layers = {0.04f, 0.14f, 1.0f}) {
        RenderOptions options;
        options.shadows = kind;
        options.shadowResolution = resolution;
        options.subdivisions = 1;
        const auto results = light(scene, options, cases, layers);
        double sum = 0;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const double e =
                std::exp(-0.5 * static_cast<double>(results[2 * i].w)) - std::exp(-0.5 * counted[i]);
            sum += e * e;
        }
        return std::sqrt(sum / static_cast<double>(cases.size()));
    }

    TestHead head{1500};
    RenderScene scene;
    Vec3d toLight, right, up;
    std::vector<shaders::LightCase> cases;
    std::vector<double> counted;
};

TEST_F(ShadowTest, TransmittanceAgreesWithCountedFibres) {
    double mean = 0;
    for (const double n : counted) mean += n / static_cast<double>(counted.size());
    EXPECT_GT(mean, 0.7);
    const double deep = error(Shadows::deepOpacity, 256);
    const double maps = error(Shadows::opacityMaps, 256);
    const double absorption = error(Shadows::absorption, 256);
    EXPECT_LT(deep, 0.12);
    EXPECT_LT(deep, maps);
    EXPECT_LT(maps, absorption);
    EXPECT_LT(absorption, 0.3);
}

// For docs/rendering.md: --gtest_also_run_disabled_tests --gtest_filter=*ErrorTable
TEST_F(ShadowTest, DISABLED_ErrorTable) {
    std::printf("| map | 64 | 128 | 256 | 512 | 1024 |\n|---|---|---|---|---|---|\n");
    const auto row = [&](const char* name, Shadows kind, std::array<float, 3> layers) {
        std::printf("| %s |", name);
        for (const std::uint32_t resolution : {64u, 128u, 256u, 512u, 1024u}) {
            std::printf(" %.3f |", error(kind, resolution, layers));
        }
        std::printf("\n");
    };
    row("deep, 1 layer", Shadows::deepOpacity, {0.9998f, 0.9999f, 1.0f});
    row("deep, 2 layers (0.1, 1)", Shadows::deepOpacity, {0.1f, 0.9999f, 1.0f});
    row("deep, 3 layers (0.02, 0.08, 1)", Shadows::deepOpacity, {0.02f, 0.08f, 1.0f});
    row("deep, 3 layers (0.04, 0.14, 1)", Shadows::deepOpacity, {0.04f, 0.14f, 1.0f});
    row("deep, 3 layers (0.08, 0.25, 1)", Shadows::deepOpacity, {0.08f, 0.25f, 1.0f});
    row("deep, 3 layers (0.15, 0.4, 1)", Shadows::deepOpacity, {0.15f, 0.4f, 1.0f});
    row("deep, 3 equal layers", Shadows::deepOpacity, {0.3333f, 0.6667f, 1.0f});
    row("opacity maps, 4 layers", Shadows::opacityMaps, {});
    row("absorption", Shadows::absorption, {});
}

}  // namespace
}  // namespace hairloom::render
