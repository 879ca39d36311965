// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kSize = 64;

RenderOptions smallOptions(std::uint32_t frames) {
    RenderOptions options;
    options.width = options.height = kSize;
    options.frames = frames;
    options.shadowResolution = 128;
    options.transparentBackground = true;
    return options;
}

/// One metre in front of the eye a pixel is this wide.
float pixelSize(const Camera& camera) {
    return 2 * std::tan(radians(camera.verticalFov) / 2) / kSize;
}

Camera straightCamera() {
    Camera camera;
    camera.eye_ws = {0, 0, 1};
    camera.target_ws = {0, 0, 0};
    return camera;
}

// Whatever its width, a hair covers as much as it is wide: alpha added up across it is its diameter in
// pixels.
TEST_F(RenderTest, HairsCoverTheirWidth) {
    RenderScene scene;
    scene.camera = straightCamera();
    for (const float diameter_px : {0.15f, 0.5f, 1.0f, 2.5f, 7.0f}) {
        TestStrands strands;
        const float radius = diameter_px * pixelSize(scene.camera) / 2;
        strands.add({Vec3f(-1, 0.013f, 0), Vec3f(0, 0.013f, 0), Vec3f(1, 0.013f, 0)}, radius);
        scene.strands = {strands.view()};
        const auto picture = renderPicture(*device, scene, smallOptions(64));
        ASSERT_TRUE(picture) << picture.error().message();
        double alpha = 0;
        for (std::size_t i = 0; i < picture->linear.rgba.size(); i += 4) {
            alpha += static_cast<double>(picture->linear.rgba[i + 3]);
        }
        EXPECT_NEAR(alpha / kSize, static_cast<double>(diameter_px), 0.04 * static_cast<double>(diameter_px));
    }
}

TEST_F(RenderTest, RibbonLiesWhereTheCurveLies) {
    RenderScene scene;
    scene.camera = straightCamera();
    TestStrands strands;
    const float pixel = pixelSize(scene.camera);
    // 10.5 pixels above the middle, 4 pixels thick: the rows from 19.5 to 23.5.
    strands.add({Vec3f(-1, 10.5f * pixel, 0), Vec3f(1, 10.5f * pixel, 0)}, 2 * pixel);
    scene.strands = {strands.view()};
    const auto picture = renderPicture(*device, scene, smallOptions(1));
    ASSERT_TRUE(picture) << picture.error().message();
    const auto alpha = [&](std::size_t row) {
        return picture->linear.rgba[4 * (row * kSize + kSize / 2) + 3];
    };
    EXPECT_EQ(alpha(18), 0);
    EXPECT_NEAR(alpha(19), 0.5f, 0.26f);
    EXPECT_EQ(alpha(20), 1);
    EXPECT_EQ(alpha(22), 1);
    EXPECT_NEAR(alpha(23), 0.5f, 0.26f);
    EXPECT_EQ(alpha(24), 0);
}

TEST_F(RenderTest, SamePictureTwice) {
    const TestHead head(400);
    RenderOptions options = smallOptions(3);
    options.transparentBackground = false;
    options.ribbons = Ribbons::strip;  // on a GPU, too
    const auto first = renderPicture(*device, head.scene(), options);
    const auto second = renderPicture(*device, head.scene(), options);
    ASSERT_TRUE(first) << first.error().message();
    ASSERT_TRUE(second);
    EXPECT_EQ(first->image.rgba, second->image.rgba);
    EXPECT_EQ(first->linear.rgba, second->linear.rgba);
    EXPECT_EQ(first->strands, 400u);
    EXPECT_EQ(first->curvePoints, 400u * 15u);
    EXPECT_EQ(first->triangles, head.indices.size() / 3);
    std::vector<std::string> names;
    for (const auto& pass : first->passes) names.push_back(pass.name);
    EXPECT_THAT(names, testing::ElementsAre("curves", "head depth", "first hair", "opacity layers",
                                            "sky head depth", "sky first hair", "sky layers", "sky seen",
                                            "shade", "draw", "accumulate", "tone map"));
}

TEST_F(RenderTest, HairShadowsHairAndHead) {
    const TestHead head(1500);
    RenderScene scene = head.scene();
    RenderOptions options = smallOptions(2);
    const auto shadowed = renderPicture(*device, scene, options);
    options.shadows = Shadows::none;
    const auto lit = renderPicture(*device, scene, options);
    ASSERT_TRUE(shadowed) << shadowed.error().message();
    ASSERT_TRUE(lit);
    EXPECT_LT(meanLuminance(shadowed->linear), 0.85 * meanLuminance(lit->linear));
    for (std::size_t i = 3; i < lit->linear.rgba.size(); i += 4) {
        ASSERT_EQ(lit->linear.rgba[i], shadowed->linear.rgba[i]);
    }
}

// N layers of parallel hairs between the light and a plate: each lets exp(-0.5 * coverage) of the light pass.
TEST_F(RenderTest, OpacityLayersCountFibres) {
    const TestPlate plate;
    const auto plateLuminance = [&](int layers) {
        TestStrands strands;
        for (int layer = 0; layer < layers; ++layer) {
            for (int i = -50; i < 50; ++i) {
                const float x = static_cast<float>(i) * 0.002f;
                const float y = 0.3f + 0.01f * static_cast<float>(layer);
                strands.add({Vec3f(x, y, -0.1f), Vec3f(x, y, 0.1f)}, 0.0005f);  // half of the area
            }
        }
        RenderScene scene;
        RenderMesh mesh = plate.mesh();
        scene.meshes = {mesh};
        scene.strands = {strands.view()};
        scene.camera.eye_ws = {0, 0.2f, 0};
        scene.camera.target_ws = {0, 0, 0};
        scene.camera.up_ws = Vec3f::UnitZ();
        scene.camera.verticalFov = 20;
        scene.environment = {};
        Light light;
        light.toLight_ws = Vec3f::UnitY();
        scene.lights = {light};
        RenderOptions options = smallOptions(1);
        options.shadows = layers >= 0 ? Shadows::deepOpacity : Shadows::none;
        // Depth of the shadow frustum must reach the plate.
        strands.add({Vec3f(0.095f, 0.0005f, 0.095f), Vec3f(0.096f, 0.0005f, 0.095f)}, 0.00001f);
        scene.strands = {strands.view()};
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << picture.error().message();
        return picture ? meanLuminance(picture->linear) : 0.0;
    };
    const double lit = plateLuminance(-1);
    for (const int layers : {1, 2, 4, 8}) {
        EXPECT_NEAR(plateLuminance(layers) / lit, std::exp(-0.5 * 0.5 * layers), 0.04) << layers;
    }
}

TEST_F(RenderTest, EmptyScenesShowTheBackground) {
    RenderScene scene;
    scene.camera = straightCamera();
    RenderOptions options = smallOptions(1);
    options.transparentBackground = false;
    const auto picture = renderPicture(*device, scene, options);
    ASSERT_TRUE(picture) << picture.error().message();
    for (std::size_t i = 0; i < picture->linear.rgba.size(); i += 4) {
        ASSERT_NEAR(picture->linear.rgba[i], scene.background.x(), 1e-4f);
        ASSERT_EQ(picture->linear.rgba[i + 3], 1);
    }
}

TEST_F(RenderTest, AbsurdRequestsAreErrors) {
    RenderScene scene;
    scene.camera = straightCamera();
    const auto refuses = [&](const RenderOptions& options, const std::string& part) {
        const auto picture = renderPicture(*device, scene, options);
        ASSERT_FALSE(picture);
        EXPECT_THAT(picture.error().message(), testing::HasSubstr(part));
    };
    RenderOptions options = smallOptions(1);
    options.width = options.height = 0;
    refuses(options, "0x0");
    options.width = options.height = 100000;
    refuses(options, "100000x100000");
    options = smallOptions(0);
    refuses(options, "frames");
    options = smallOptions(1);
    options.samples = 3;
    refuses(options, "3 samples");
    options = smallOptions(1);
    options.subdivisions = 0;
    refuses(options, "subdivisions");
    options = smallOptions(1);
    options.shadowResolution = 1u << 30u;
    refuses(options, "shadow map");
    options = smallOptions(1);
    options.shadowLights = 17;
    refuses(options, "17 lights");
}

TEST_F(RenderTest, BrokenScenesAreErrors) {
    const auto message = [&](const RenderScene& scene) {
        const auto picture = renderPicture(*device, scene, smallOptions(1));
        return picture ? std::string() : picture.error().message();
    };
    TestHead head(3);
    head.strands.positions[9].y() = std::nanf("");
    EXPECT_THAT(message(head.scene()), testing::HasSubstr("point 1 of strand 1"));
    head = TestHead(3);
    head.strands.offsets[2] = 5000;
    EXPECT_THAT(message(head.scene()), testing::HasSubstr("strand 1"));
    head = TestHead(3);
    RenderScene scene = head.scene();
    // Framing, done before, would read the corner.
    head.indices[4] = 77777;
    EXPECT_THAT(message(scene), testing::HasSubstr("77777"));
    head = TestHead(3);
    scene = head.scene();
    scene.camera.eye_ws.x() = std::nanf("");
    EXPECT_THAT(message(scene), testing::HasSubstr("camera"));
}

TEST_F(RenderTest, EachSampleCountWorks) {
    const TestHead head(50);
    EXPECT_GE(device->info().sampleCounts.size(), 2u);
    for (const std::uint32_t samples : device->info().sampleCounts) {
        if (samples > 8) continue;
        RenderOptions options = smallOptions(2);
        options.samples = samples;
        const auto picture = renderPicture(*device, head.scene(), options);
        EXPECT_TRUE(picture) << picture.error().message();
    }
}

}  // namespace
}  // namespace hairloom::render
