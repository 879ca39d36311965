// SPDX-License-Identifier: GPL-3.0-or-later
// Frames that join those before them, against many passes of the same moment.
#include <gmock/gmock.h>

#include <numeric>

#include "core/render/renderer.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kSize = 128;

class TemporalTest : public RenderTest {
  protected:
    /// As the viewport draws while something moves.
    static RenderOptions moving(bool temporal) {
        RenderOptions options;
        options.width = options.height = kSize;
        options.frames = options.samples = options.subdivisions = 1;
        options.shadowResolution = 512;
        options.skyStrands = 1024;
        options.detail = 0.5f;
        options.temporal = temporal;
        return options;
    }
    Image frame(Renderer& renderer, const RenderOptions& options) {
        const auto picture = renderPicture(*device, renderer, options);
        EXPECT_TRUE(picture) << picture.error().message();
        linear_ = picture ? picture->linear : LinearImage();
        return picture ? picture->image : Image();
    }
    /// The same moment, without what was before.
    Image truth(const RenderScene& scene, double* luminance = nullptr) {
        RenderOptions options = moving(false);
        options.frames = 64;
        options.samples = 4;
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << picture.error().message();
        if (picture && luminance != nullptr) *luminance = meanLuminance(picture->linear);
        return picture ? picture->image : Image();
    }
    LinearImage linear_;
};

/// Hair that sways under a head that nods, while the camera goes around.
struct Moving {
    TestHead rest{2500};
    TestHead now = rest;
    Camera camera = rest.scene().camera;

    void at(int frame, bool cameraMoves = true) {
        const float t = static_cast<float>(frame) / 60;
        const Eigen::AngleAxisf nod(0.25f * std::sin(4 * t), Vec3f::UnitX());
        for (std::size_t i = 0; i < rest.positions.size(); ++i) now.positions[i] = nod * rest.positions[i];
        for (std::size_t i = 0; i < rest.strands.positions.size(); ++i) {
            const Vec3f& p = rest.strands.positions[i];
            const float down = std::max(0.1f - p.y(), 0.0f);
            now.strands.positions[i] = nod * (p + Vec3f(down * 0.15f * std::sin(6 * t), 0, 0));
        }
        camera = rest.scene().camera;
        if (cameraMoves) {
            const Eigen::AngleAxisf around(0.5f * t, Vec3f::UnitY());
            camera.eye_ws = camera.target_ws + around * (camera.eye_ws - camera.target_ws);
        }
    }
    RenderScene scene() const {
        RenderScene scene = now.scene();
        scene.camera = camera;
        scene.lights = studioLights(rest.scene().camera);
        return scene;
    }
    void show(Renderer& renderer) const {
        EXPECT_TRUE(renderer.setCamera(camera));
        EXPECT_TRUE(renderer.setMeshPositions(0, now.positions));
        EXPECT_TRUE(renderer.setStrandPositions(0, now.strands.positions));
    }
};

/// What changes from frame to frame that should not: root mean square of the change of the error by the mean.
double flicker(const std::array<Image, 2>& shown, const std::array<Image, 2>& expected) {
    double changes = 0, light = 0;
    for (std::size_t i = 0; i < shown[0].rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const auto error = [&](std::size_t k) {
            return static_cast<double>(shown[k].rgba[i]) - static_cast<double>(expected[k].rgba[i]);
        };
        changes += (error(1) - error(0)) * (error(1) - error(0)) / 2;
        light += static_cast<double>(expected[0].rgba[i]);
    }
    const double count = 0.75 * static_cast<double>(shown[0].rgba.size());
    return std::sqrt(changes / count) / (light / count);
}

// Both as software and as a GPU draws them, against the same passes.
TEST_F(TemporalTest, MovingHairIsNearManyPasses) {
    Moving hair;
    Renderer joined(*device), ofGpu(*device), alone(*device);
    for (Renderer* renderer : {&joined, &ofGpu, &alone}) ASSERT_TRUE(renderer->setScene(hair.scene()));
    RenderOptions sorted = moving(true);
    sorted.transparency = Transparency::sorted;
    std::array<Image, 2> shown, ordered, single, expected;
    for (std::uint32_t i = 0; i < 26; ++i) {
        hair.at(static_cast<int>(i));
        hair.show(joined);
        hair.show(ofGpu);
        const Image now = frame(joined, moving(true)), inOrder = frame(ofGpu, sorted);
        if (i < 24) continue;
        const double light = meanLuminance(linear_);
        const std::size_t k = i - 24;
        shown[k] = now;
        ordered[k] = inOrder;
        hair.show(alone);
        single[k] = frame(alone, moving(false));
        double wanted = 0;
        expected[k] = truth(hair.scene(), &wanted);
        EXPECT_GT(decibels(shown[k], expected[k]), 34);
        EXPECT_GT(decibels(shown[k], expected[k]), decibels(single[k], expected[k]) + 7);
        EXPECT_GT(decibels(ordered[k], expected[k]), 36);
        EXPECT_NEAR(light / wanted, 1, 0.02);
    }
    EXPECT_LT(flicker(shown, expected), 0.02);
    EXPECT_LT(flicker(ordered, expected), 0.02);
    EXPECT_GT(flicker(single, expected), 0.05);
}

TEST_F(TemporalTest, WhatRestsBecomesAStillPicture) {
    Moving still;
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(still.scene()));
    Image shown;
    for (int i = 0; i < 64; ++i) shown = frame(renderer, moving(true));
    EXPECT_GT(decibels(shown, truth(still.scene())), 43);
    const double light = meanLuminance(linear_);
    // The mean is that of passes, and that of the settings of a view that has stopped.
    Renderer plain(*device);
    ASSERT_TRUE(plain.setScene(still.scene()));
    RenderOptions average = moving(false);
    average.frames = 64;
    frame(plain, average);
    EXPECT_NEAR(light / meanLuminance(linear_), 1, 0.005);
    average.subdivisions = 2;
    average.samples = 4;
    average.detail = 0;
    average.shadowResolution = 1024;
    average.skyStrands = 8192;
    frame(plain, average);
    EXPECT_NEAR(light / meanLuminance(linear_), 1, 0.02);
}

TEST_F(TemporalTest, WhatWasHiddenBeginsAnew) {
    // A wide strand jumps aside: behind it nothing of it stays.
    TestStrands strands;
    strands.add({Vec3f(0, -1, 0), Vec3f(0, 1, 0)}, 0.3f);
    const TestPlate plate;
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.camera.eye_ws = Vec3f(0, 0, 3);
    scene.camera.target_ws = Vec3f::Zero();
    scene.background = Vec3f(0.1f, 0.5f, 0.1f);
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(scene));
    RenderOptions options = moving(true);
    options.detail = 0;
    for (int i = 0; i < 8; ++i) frame(renderer, options);
    for (Vec3f& p : strands.positions) p.x() += 0.5f;
    ASSERT_TRUE(renderer.setStrandPositions(0, strands.positions));
    frame(renderer, options);
    const std::size_t middle = std::size_t{4} * (kSize * kSize / 2 + kSize / 2);
    EXPECT_NEAR(linear_.rgba[middle], 0.1f, 1e-3f);
    EXPECT_NEAR(linear_.rgba[middle + 1], 0.5f, 1e-3f);
}

}  // namespace
}  // namespace hairloom::render
