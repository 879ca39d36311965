// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures without perspective: what is equal looks equal, near, far and behind the eye.
#include <array>
#include <optional>
#include <utility>

#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kSize = 96;
constexpr float kHeight = 0.24f;  // metres

Camera headOn() {
    Camera camera;
    camera.eye_ws = {0, 0, 1};
    camera.target_ws = {0, 0, 0};
    camera.orthographicHeight = kHeight;
    return camera;
}

RenderOptions optionsOf(Ribbons ribbons) {
    RenderOptions options;
    options.width = options.height = kSize;
    options.frames = 1;
    options.shadows = Shadows::none;
    options.ribbons = ribbons;
    options.transparentBackground = true;
    return options;
}

struct Band {
    double alpha = 0;  // sum of the band's coverage, in pixels
    Vec3d light = Vec3d::Zero();
};

/// Rows from a third of the picture to the next.
Band third(const LinearImage& image, std::size_t which) {
    Band band;
    for (std::size_t i = which * kSize / 3 * kSize; i < (which + 1) * kSize / 3 * kSize; ++i) {
        band.alpha += static_cast<double>(image.rgba[4 * i + 3]);
        for (int c = 0; c < 3; ++c) {
            band.light[c] += static_cast<double>(image.rgba[4 * i + static_cast<std::size_t>(c)]);
        }
    }
    return band;
}

class OrthographicTest : public RenderTest {
  protected:
    LinearImage draw(const RenderScene& scene, const RenderOptions& options) {
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? picture->linear : LinearImage{};
    }
};

TEST_F(OrthographicTest, AHairIsOfEqualSizeAndLightAtAnyDepth) {
    const std::array<std::pair<Ribbons, ShadingModel>, 4> ways{{{Ribbons::strip, ShadingModel::kajiya},
                                                                {Ribbons::tessellated, ShadingModel::kajiya},
                                                                {Ribbons::compute, ShadingModel::kajiya},
                                                                {Ribbons::strip, ShadingModel::marschner}}};
    for (const auto& [ribbons, model] : ways) {
        if (ribbons == Ribbons::tessellated && !device->info().tessellation) continue;
        std::optional<Band> first;
        for (const float z : {-2.0f, 0.6f, 3.0f}) {  // the last is behind the eye
            TestStrands strands;
            strands.add({Vec3f(-0.06f, 0.01f, z), Vec3f(0, 0.01f, z), Vec3f(0.06f, 0.01f, z)}, 0.006f);
            RenderScene scene;
            scene.camera = headOn();
            scene.environment = Environment();
            scene.lights = {Light{}};
            scene.lights[0].toLight_ws = Vec3f(0.3f, 0.8f, 0.6f);
            scene.strands = {strands.view()};
            scene.strands[0].material.fibre.model = model;
            const LinearImage image = draw(scene, optionsOf(ribbons));
            ASSERT_FALSE(image.rgba.empty());
            const Band band = third(image, 1);
            // 0.12 m by 0.012 m, in pixels of 0.24 m / 96.
            EXPECT_NEAR(band.alpha, 48 * 4.8, 48 * 0.25) << "a quarter of a row";
            EXPECT_GT(band.light.sum(), 0.5);
            if (!first) first = band;
            EXPECT_NEAR(band.alpha, first->alpha, 1) << z << ", ribbons " << static_cast<int>(ribbons);
            EXPECT_LT((band.light - first->light).norm(), 0.01 * first->light.norm())
                << z << ", ribbons " << static_cast<int>(ribbons) << ", model " << static_cast<int>(model);
        }
    }
}

TEST_F(OrthographicTest, EqualHeadsAtAnyDepthAreOfEqualSize) {
    std::vector<Vec3f> plates;
    std::vector<std::uint32_t> indices;
    const std::array<float, 3> depths{0.4f, -5.0f, 2.0f};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3f middle(0.02f, kHeight / 3 * (1 - static_cast<float>(i)), depths[i]);
        const auto first = static_cast<std::uint32_t>(plates.size());
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            plates.push_back(middle + 0.03f * Vec3f(static_cast<float>(x), static_cast<float>(y), 0));
        }
        for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + corner);
    }
    RenderScene scene;
    scene.camera = headOn();
    scene.lights = {Light{}};
    scene.lights[0].castsShadow = false;
    RenderMesh mesh;
    mesh.positions_ws = plates;
    mesh.indices = indices;
    scene.meshes = {mesh};
    for (const Ribbons ribbons : {Ribbons::strip, Ribbons::compute}) {
        const LinearImage image = draw(scene, optionsOf(ribbons));
        ASSERT_FALSE(image.rgba.empty());
        const Band first = third(image, 0);
        EXPECT_NEAR(first.alpha, 24 * 24, 13);
        for (const std::size_t other : {1u, 2u}) {
            const Band band = third(image, other);
            EXPECT_NEAR(band.alpha, first.alpha, 0.5) << other;
            EXPECT_LT((band.light - first.light).norm(), 0.01 * first.light.norm()) << other;
        }
    }
}

// Weighted transparency weighs by depth, which clip space has in another way than with perspective.
TEST_F(OrthographicTest, BlendedHairInFrontHidesHairBehind) {
    RenderScene scene;
    scene.camera = headOn();
    scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    RenderOptions options = optionsOf(Ribbons::strip);
    options.transparency = Transparency::weighted;
    std::array<Vec3d, 2> seen;
    for (const std::size_t front : {0u, 1u}) {
        TestStrands strands;
        const float z = front == 0 ? 0.05f : -0.05f;
        strands.add({Vec3f(-0.05f, 0, z), Vec3f(0.05f, 0, z)}, 0.02f);
        strands.add({Vec3f(-0.05f, 0, -z), Vec3f(0.05f, 0, -z)}, 0.02f);
        const std::array<Vec3f, 2> colours{Vec3f(0.9f, 0.05f, 0.05f), Vec3f(0.05f, 0.05f, 0.9f)};
        scene.strands = {strands.view()};
        scene.strands[0].colours = colours;
        seen[front] = third(draw(scene, options), 1).light;
    }
    EXPECT_GT(seen[0].x(), 3 * seen[0].z()) << "red in front";
    EXPECT_GT(seen[1].z(), 3 * seen[1].x()) << "blue in front";
}

}  // namespace
}  // namespace hairloom::render
