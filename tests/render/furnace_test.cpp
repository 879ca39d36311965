// SPDX-License-Identifier: GPL-3.0-or-later
// Fibres under light of one strength from all directions, as they are drawn: by quadrature over the sphere.
#include <gmock/gmock.h>

#include <numbers>

#include "core/render/renderer.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kHairs = 12;
constexpr std::uint32_t kSize = 48;
constexpr int kDirections = 304;  // of whole rounds of lights

/// Straight hairs beside each other, which lean towards the view or away from it by -84° to 84°, seen without
/// perspective.
struct Fan {
    TestStrands strands;

    Fan() {
        for (std::uint32_t i = 0; i < kHairs; ++i) {
            const float x = -0.95f + 1.9f * (static_cast<float>(i) + 0.5f) / kHairs;
            const float lean = radians(-84.0f + 168.0f * static_cast<float>(i) / (kHairs - 1));
            const Vec3f half(0, 2 * std::cos(lean), 2 * std::sin(lean));
            strands.add({Vec3f(x, 0, 0) - half, Vec3f(x, 0, 0) + half}, 0.05f);
        }
    }
    RenderScene scene() const {
        RenderScene scene;
        scene.strands = {strands.view()};
        scene.camera.eye_ws = Vec3f(0, 0, 5);
        scene.camera.target_ws = Vec3f::Zero();
        scene.camera.orthographicHeight = 2;
        scene.environment = {};
        StrandShading& material = scene.strands[0].material;
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
        return scene;
    }
};

class FurnaceTest : public RenderTest {
  protected:
    /// Of each hair, the brightest channel.
    std::vector<double> light(const RenderScene& scene) {
        RenderOptions options;
        options.width = options.height = kSize;
        options.samples = options.frames = options.subdivisions = 1;
        options.shadows = Shadows::none;
        Renderer renderer(*device);
        EXPECT_TRUE(renderer.setScene(scene));
        std::vector<Vec3d> sums(kHairs, Vec3d::Zero());
        for (int i = 0; i < kDirections; i += kMaxLights) {
            std::vector<Light> lights(kMaxLights);
            for (int k = 0; k < static_cast<int>(kMaxLights); ++k) {
                // Fibonacci's spiral: each stands for as much of the sphere.
                const double y = 1 - 2 * (i + k + 0.5) / kDirections;
                const double turn = (i + k) * std::numbers::pi * (3 - std::sqrt(5.0));
                const double r = std::sqrt(1 - y * y);
                Light& light = lights[static_cast<std::size_t>(k)];
                light.toLight_ws = Vec3d(r * std::cos(turn), y, r * std::sin(turn)).cast<float>();
                light.irradiance = Vec3f::Constant(4 * kPi / kDirections);
                light.castsShadow = false;
            }
            EXPECT_TRUE(renderer.setLights(lights));
            const auto picture = renderPicture(*device, renderer, options).value();
            for (std::uint32_t hair = 0; hair < kHairs; ++hair) {
                const std::uint32_t x = static_cast<std::uint32_t>(
                    (0.025f + 0.95f * (static_cast<float>(hair) + 0.5f) / kHairs) * kSize);
                const float* pixel = &picture.linear.rgba[4 * (std::size_t{kSize / 2} * kSize + x)];
                sums[hair] += Vec3f(pixel[0], pixel[1], pixel[2]).cast<double>();
            }
        }
        std::vector<double> result;
        for (const Vec3d& sum : sums) result.push_back(sum.maxCoeff());
        return result;
    }
};

TEST_F(FurnaceTest, WhiteHairOfKajiyaKayIsNoBrighterThanWhatIsAroundIt) {
    const Fan fan;
    RenderScene scene = fan.scene();
    StrandShading& material = scene.strands[0].material;
    material.albedo = Vec3f::Ones();
    material.primary = Vec3f::Constant(0.32f * 0.5f);
    material.secondary = Vec3f::Constant(1.1f * 0.5f);
    material.primaryExponent = 20;
    material.secondaryExponent = 8;
    for (const double seen : light(scene)) {
        EXPECT_LE(seen, 1.02);
        EXPECT_GT(seen, 0.7);
    }
    material.bounded = false;
    EXPECT_GT(std::ranges::max(light(scene)), 2.4) << "as published";
}

TEST_F(FurnaceTest, DarkHairOfKajiyaKayIsAsPublished) {
    const Fan fan;
    RenderScene scene = fan.scene();
    StrandShading& material = scene.strands[0].material;
    material.albedo = Vec3f(0.2f, 0.1f, 0.05f);
    const std::vector<double> bounded = light(scene);
    material.bounded = false;
    EXPECT_EQ(light(scene), bounded);
}

TEST_F(FurnaceTest, WhiteHairOfSadeghiIsNoBrighterThanWhatIsAroundIt) {
    const Fan fan;
    RenderScene scene = fan.scene();
    StrandShading& material = scene.strands[0].material;
    material.albedo = material.fibreColour = Vec3f::Ones();
    FibreMaterial& fibre = material.fibre;
    fibre.model = ShadingModel::sadeghi;
    fibre.scattering = Scattering::single;
    shading::MarschnerParameters white;
    white.azimuthal.absorption = Vec3d::Zero();
    white.azimuthal.width = 0.3;
    white.width = {0.15, 0.12, 0.25};  // none so narrow that few directions miss it
    fibre.sadeghi = shading::sadeghiLike(shading::Marschner(white));
    for (const double seen : light(scene)) EXPECT_LE(seen, 1.06);
    fibre.sadeghi.bounded = false;
    EXPECT_GT(std::ranges::max(light(scene)), 1.2) << "as published";
}

}  // namespace
}  // namespace hairloom::render
