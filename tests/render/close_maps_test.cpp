// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow maps of what is near the camera.
#include "core/render/close_maps.h"
#include "core/render/renderer.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr float kHairRadius = 0.00005f;

/// Hairs side by side to the right, and one above them that shades a part as wide as itself of each; far from
/// them others, so that the light's own map is coarse.
struct Crossing {
    TestStrands strands;
    RenderScene scene;

    explicit Crossing(float pixels, std::uint32_t size = 96) {
        for (int i = -22; i <= 22; ++i) {
            const float y = static_cast<float>(i) * 2.13f * kHairRadius;
            strands.add({Vec3f(-0.002f, y, 0), Vec3f(-0.001f, y, 0), Vec3f(0, y, 0), Vec3f(0.001f, y, 0),
                         Vec3f(0.002f, y, 0)},
                        kHairRadius);
        }
        strands.add({Vec3f(0, -0.002f, 0.0006f), Vec3f(0, 0, 0.0006f), Vec3f(0, 0.002f, 0.0006f)},
                    kHairRadius);
        for (const float x : {-0.15f, 0.15f}) {
            for (const float y : {-0.15f, 0.15f})
                strands.add({Vec3f(x, y, 0), Vec3f(x, y + 0.01f, 0)}, kHairRadius);
        }
        scene.strands = {strands.view()};
        StrandShading& material = scene.strands[0].material;
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
        material.fibre.model = ShadingModel::marschner;
        material.fibre.scattering = Scattering::single;
        material.fibre.marschner.azimuthal.width = 0.3;
        scene.camera.eye_ws = Vec3f(0, 0, 1);
        scene.camera.target_ws = Vec3f::Zero();
        scene.camera.orthographicHeight = 2 * kHairRadius * static_cast<float>(size) / pixels;
        scene.environment = {};
        Light light;
        // From the camera's side and the left: the shadow falls to the right of what throws it.
        light.toLight_ws = Vec3f(-1, 0, 1);
        scene.lights = {light};
    }
};

class CloseMapsTest : public RenderTest {
  protected:
    static RenderOptions options(std::uint32_t size = 96) {
        RenderOptions how;
        how.width = how.height = size;
        how.frames = 16;
        how.subdivisions = 32;
        return how;
    }
};

TEST_F(CloseMapsTest, AHairThrowsAShadowAsWideAsItself) {
    const Crossing crossing(4);
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(crossing.scene));
    const auto picture = renderPicture(*device, renderer, options());
    ASSERT_TRUE(picture) << picture.error().message();
    EXPECT_EQ(renderer.plan().closeMaps, 1u);
    // Means of columns, over whole hairs.
    const auto column = [&](std::size_t x) {
        double sum = 0;
        for (std::size_t y = 32; y < 64; ++y)
            sum += static_cast<double>(picture->linear.rgba[4 * (y * 96 + x) + 1]);
        return sum / 32;
    };
    const double open = column(20);
    // 0.6 mm behind, under 45 degrees: 24 pixels to the right.
    const double shaded = column(48 + 24);
    EXPECT_GT(open, 0.01);
    EXPECT_LT(shaded, 0.35 * open);
    EXPECT_GT(column(48 + 14), 0.85 * open);
    EXPECT_GT(column(48 + 34), 0.85 * open);
}

TEST_F(CloseMapsTest, ThinHairTubesAndMissingShadowsHaveNone) {
    Renderer renderer(*device);
    const auto maps = [&](const RenderScene& scene, const RenderOptions& how) {
        EXPECT_TRUE(renderer.setScene(scene));
        EXPECT_TRUE(renderPicture(*device, renderer, how));
        return renderer.plan().closeMaps;
    };
    EXPECT_EQ(maps(Crossing(0.35f).scene, options()), 0u);
    EXPECT_EQ(maps(Crossing(2).scene, options()), 1u);
    RenderOptions none = options();
    none.shadows = Shadows::none;
    EXPECT_EQ(maps(Crossing(2).scene, none), 0u);
    for (const Shadows kind : {Shadows::absorption, Shadows::opacityMaps}) {
        RenderOptions coarse = options();
        coarse.shadows = kind;
        EXPECT_EQ(maps(Crossing(2).scene, coarse), 0u)
            << "they cannot tell hairs of a fraction of a millimetre apart";
    }
    Crossing tubes(2);
    tubes.scene.strands[0].material.tubes = true;
    EXPECT_EQ(maps(tubes.scene, options()), 0u);
    Crossing many(2);
    many.scene.lights.resize(6, many.scene.lights[0]);
    EXPECT_EQ(maps(many.scene, options()), 4u) << "of the first lights";
}

TEST_F(CloseMapsTest, ACameraThatMovesShowsWhatOneThatStoodThereDoes) {
    Crossing crossing(4);
    Renderer moved(*device);
    ASSERT_TRUE(moved.setScene(crossing.scene));
    ASSERT_TRUE(renderPicture(*device, moved, options()));
    for (const float x : {0.0003f, 0.0008f, -0.0006f}) {
        crossing.scene.camera.eye_ws.x() = crossing.scene.camera.target_ws.x() = x;
        ASSERT_TRUE(moved.setCamera(crossing.scene.camera));
        const auto after = renderPicture(*device, moved, options());
        const auto still = renderPicture(*device, crossing.scene, options());
        ASSERT_TRUE(after && still);
        EXPECT_EQ(after->linear.rgba, still->linear.rgba) << x;
    }
}

TEST_F(CloseMapsTest, AnotherSizeShowsWhatAFreshPictureDoes) {
    const Crossing crossing(0.9f);
    Renderer resized(*device);
    ASSERT_TRUE(resized.setScene(crossing.scene));
    for (const std::uint32_t size : {96u, 192u, 48u, 130u}) {
        const auto after = renderPicture(*device, resized, options(size));
        const auto fresh = renderPicture(*device, crossing.scene, options(size));
        ASSERT_TRUE(after && fresh);
        EXPECT_EQ(after->linear.rgba, fresh->linear.rgba) << size;
    }
}

TEST_F(CloseMapsTest, AnInterruptedFrameKeepsTheAverageAndItsMaps) {
    Crossing crossing(4);
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(crossing.scene));
    ASSERT_TRUE(renderPicture(*device, renderer, options()));
    EXPECT_EQ(renderer.accumulated(), 16u);
    const auto recordOnly = [&] {
        auto list = device->createCommandList();
        ASSERT_TRUE(list);
        ASSERT_TRUE(renderer.record(**list, options(), nullptr));
    };
    const auto dropFrame = [&] {
        recordOnly();
        renderer.takeBack();
    };
    dropFrame();
    recordOnly();
    EXPECT_EQ(renderer.accumulated(), 16u);
    crossing.scene.camera.eye_ws.x() = crossing.scene.camera.target_ws.x() = 0.002f;
    ASSERT_TRUE(renderer.setCamera(crossing.scene.camera));
    dropFrame();
    const auto after = renderPicture(*device, renderer, options());
    const auto fresh = renderPicture(*device, crossing.scene, options());
    ASSERT_TRUE(after && fresh);
    EXPECT_EQ(after->linear.rgba, fresh->linear.rgba);
}

TEST_F(CloseMapsTest, LightChangesGraduallyAsTheCameraComesNear) {
    double before = 0;
    for (float pixels = 0.35f; pixels < 1.75f; pixels += 0.05f) {
        const auto picture = renderPicture(*device, Crossing(pixels).scene, options());
        ASSERT_TRUE(picture);
        // The same square of hair, whatever the size of a pixel.
        double sum = 0, count = 0;
        const auto half = static_cast<int>(std::lround(20 * pixels));
        for (int y = 48 - half; y < 48 + half; ++y) {
            for (int x = 48 - half; x < 48 + half; ++x, ++count)
                sum +=
                    static_cast<double>(picture->linear.rgba[4 * static_cast<std::size_t>(y * 96 + x) + 1]);
        }
        const double mean = sum / count;
        if (before > 0) {
            EXPECT_NEAR(mean / before, 1, 0.06) << pixels;  // rows of pixels and of hairs beat by 0.053
        }
        before = mean;
    }
}

TEST_F(CloseMapsTest, AdaptiveMapsComeNearAsWell) {
    const Crossing crossing(4);
    for (const Shadows kind : {Shadows::deepOpacity, Shadows::adaptive}) {
        RenderOptions how = options();
        how.shadows = kind;
        const auto picture = renderPicture(*device, crossing.scene, how);
        ASSERT_TRUE(picture) << picture.error().message();
        double shaded = 0, open = 0;
        for (std::size_t y = 32; y < 64; ++y) {
            shaded += static_cast<double>(picture->linear.rgba[4 * (y * 96 + 72) + 1]);
            open += static_cast<double>(picture->linear.rgba[4 * (y * 96 + 20) + 1]);
        }
        EXPECT_LT(shaded, 0.5 * open) << static_cast<int>(kind);
    }
}

}  // namespace
}  // namespace hairloom::render
