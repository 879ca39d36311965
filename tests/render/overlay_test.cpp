// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/overlay.h"

#include "core/render/renderer.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kSize = 64;

/// A black picture of 64 x 64 pixels, one metre wide at z = 0, with marks on it.
class OverlayTest : public RenderTest {
  protected:
    std::vector<std::uint8_t> draw(const Overlay& overlay, gpu::Format format = gpu::Format::Rgba8Unorm) {
        RenderScene scene;
        scene.camera.eye_ws = {0, 0, 2};
        scene.camera.target_ws = {0, 0, 0};
        scene.camera.verticalFov = 2 * std::atan(0.25f) * 180 / kPi;
        scene.background = Vec3f::Zero();
        if (plate) {
            RenderMesh mesh;
            mesh.positions_ws = corners;
            mesh.indices = indices;
            scene.meshes = {mesh};
            scene.environment = {};
        }
        RenderOptions options;
        options.width = options.height = kSize;
        options.frames = 1;
        gpu::TextureDesc desc;
        desc.name = "test";
        desc.width = desc.height = kSize;
        desc.format = format;
        desc.usage = gpu::Usage::RenderTarget;
        const auto target = device->createTexture(desc).value();
        Renderer renderer(*device);
        EXPECT_TRUE(renderer.setScene(scene));
        EXPECT_TRUE(renderer.setOverlay(overlay));
        auto list = device->createCommandList().value();
        EXPECT_TRUE(renderer.record(*list, options, target));
        const auto submission = device->submit(std::move(list));
        EXPECT_TRUE(submission) << (submission ? "" : submission.error().message());
        std::vector<std::uint8_t> pixels(std::size_t{4} * kSize * kSize);
        EXPECT_TRUE(device->readTexture(target, std::as_writable_bytes(std::span(pixels))));
        return pixels;
    }
    static int red(const std::vector<std::uint8_t>& pixels, std::size_t x, std::size_t y) {
        return pixels[4 * (y * kSize + x)];
    }
    /// Of all pixels, in pixels of full red.
    static double area(const std::vector<std::uint8_t>& pixels) {
        double sum = 0;
        for (std::size_t i = 0; i < pixels.size(); i += 4) sum += pixels[i] / 255.0;
        return sum;
    }
    static OverlayVertex at(float x, float y, float z = 0) { return {Vec4f(x, y, z, 1), Vec4f(1, 0, 0, 1)}; }
    const std::vector<Vec3f> corners = {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}};  // the left half
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
    bool plate = false;
};

TEST_F(OverlayTest, MarkersHaveTheirSizeAndPosition) {
    Overlay overlay;
    overlay.batches.push_back({OverlayShape::points, 10, true, {at(0.25f, 0.25f)}});
    auto pixels = draw(overlay);
    EXPECT_NEAR(area(pixels), 25 * static_cast<double>(kPi), 2.5);
    EXPECT_EQ(red(pixels, 48, 16), 255);
    EXPECT_EQ(red(pixels, 40, 16), 0);

    overlay.batches = {{OverlayShape::lines, 3, true, {at(-0.25f, 0), at(0.25f, 0)}}};
    pixels = draw(overlay);
    EXPECT_NEAR(area(pixels), 32 * 3 + 2.25 * static_cast<double>(kPi), 3);
    EXPECT_EQ(red(pixels, 32, 32), 255);
    EXPECT_EQ(red(pixels, 32, 36), 0);

    overlay.batches = {
        {OverlayShape::triangles, 1, true, {at(-0.5f, -0.5f), at(0.5f, -0.5f), at(0.5f, 0.5f)}}};
    EXPECT_NEAR(area(draw(overlay)), kSize * kSize / 2, kSize);
}

TEST_F(OverlayTest, MeshesHideWhatLiesBehindThem) {
    plate = true;
    Overlay overlay;
    overlay.batches = {{OverlayShape::lines, 4, false, {at(-0.4f, 0, -0.1f), at(0.4f, 0, -0.1f)}}};
    const auto behind = draw(overlay);
    EXPECT_EQ(red(behind, 16, 32), 0);
    EXPECT_EQ(red(behind, 48, 32), 255);
    // Marks on the surface itself are seen.
    overlay.batches = {{OverlayShape::lines, 4, false, {at(-0.4f, 0), at(0.4f, 0)}}};
    EXPECT_EQ(red(draw(overlay), 16, 32), 255);
    overlay.batches = {{OverlayShape::lines, 4, true, {at(-0.4f, 0, -0.1f), at(0.4f, 0, -0.1f)}}};
    EXPECT_EQ(red(draw(overlay), 16, 32), 255);
}

TEST_F(OverlayTest, LinesThroughTheEyeEndBeforeIt) {
    Overlay overlay;
    overlay.batches = {{OverlayShape::lines, 2, true, {at(0.1f, 0, 0), at(0.1f, 0, 5)}}};
    const auto pixels = draw(overlay);
    EXPECT_GT(red(pixels, 45, 32), 100);  // on its way out to the right
    EXPECT_EQ(red(pixels, 20, 32), 0);
}

TEST_F(OverlayTest, ColoursAreAsAskedForInEachFormat) {
    Overlay overlay;
    // What a byte can hold: devices may round halves up and down.
    const Vec4f colour(128.0f / 255, 64.0f / 255, 0, 1);
    overlay.batches = {{OverlayShape::points, 20, true, {{Vec4f(0, 0, 0, 1), colour}}}};
    const auto plain = draw(overlay);
    const auto encoded = draw(overlay, gpu::Format::Rgba8UnormSrgb);
    const std::size_t middle = 4 * (32 * kSize + 32);
    EXPECT_EQ(plain[middle], 128);
    EXPECT_EQ(plain[middle + 1], 64);
    EXPECT_NEAR(encoded[middle], 128, 1);
    EXPECT_NEAR(encoded[middle + 1], 64, 1);
}

TEST_F(OverlayTest, InvalidMarkersAreErrors) {
    Overlay overlay;
    overlay.batches = {{OverlayShape::lines, 2, true, {at(0, 0)}}};
    EXPECT_FALSE(check(overlay));
    overlay.batches = {{OverlayShape::points, 2, true, {at(0, std::nanf(""))}}};
    EXPECT_FALSE(check(overlay));
    overlay.batches = {{OverlayShape::points, -1, true, {at(0, 0)}}};
    EXPECT_FALSE(check(overlay));
    EXPECT_TRUE(check(Overlay()));
}

}  // namespace
}  // namespace hairloom::render
