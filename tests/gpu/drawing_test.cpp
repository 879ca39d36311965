// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/gpu/gpu_fixture.h"

namespace hairloom::gpu {
namespace {

struct Point {
    float x, y, z;
};

class DrawingTest : public GpuTest {
  protected:
    TexturePtr target(std::uint32_t size, Format format, std::uint32_t samples) {
        TextureDesc desc;
        desc.name = "target";
        desc.width = desc.height = size;
        desc.format = format;
        desc.samples = samples;
        desc.usage = Usage::RenderTarget;
        return device->createTexture(desc).value();
    }
};

// Corners in Direct3D's clip space: +y is up, the first row of the image is the upper one.
TEST_F(DrawingTest, TriangleCoversThePixelsWhoseCentresItContains) {
    constexpr int kSize = 64;
    const std::array<Point, 3> corners = {
        Point{-0.83f, 0.91f, 0.5f}, {0.37f, 0.53f, 0.5f}, {-0.61f, -0.71f, 0.5f}};
    GraphicsPipelineDesc desc;
    desc.name = "triangle";
    desc.vertex = shader("triangle.vert", ShaderStage::Vertex);
    desc.pixel = shader("triangle.frag", ShaderStage::Pixel);
    desc.attributes = {VertexAttribute{}};
    desc.vertexStride = sizeof(Point);
    desc.colourFormats = {Format::Rgba8Unorm};
    desc.blend = {BlendDesc{}};
    desc.raster.cull = Cull::Back;
    const auto pipeline = device->createGraphicsPipeline(desc);
    ASSERT_TRUE(pipeline) << pipeline.error().message();
    const TexturePtr picture = target(kSize, Format::Rgba8Unorm, 1);
    const BufferPtr vertices = buffer(std::vector<Point>(corners.begin(), corners.end()), Usage::Vertex);
    EXPECT_EQ(submitError([&](CommandList& list) {
                  list.beginPass({"draw", {{picture, LoadOp::Clear, {0, 1, 0, 1}, {}}}, {}});
                  list.setPipeline(*pipeline);
                  list.setVertexBuffer(vertices, 0);
                  list.draw(3);
                  list.endPass();
              }),
              "");
    const auto pixels = read<std::uint8_t>(picture);
    int covered = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const double px = (x + 0.5) / kSize * 2 - 1;
            const double py = 1 - (y + 0.5) / kSize * 2;
            double depth = 1e9;  // distance to the nearest edge in pixels, negative outside
            for (std::size_t i = 0; i < 3; ++i) {
                const Point& a = corners[i];
                const Point& b = corners[(i + 1) % 3];
                const double length = std::hypot(b.x - a.x, b.y - a.y);
                const double side = (b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x);
                depth = std::min(depth, -side / length * kSize / 2);
            }
            // Devices keep corners to 1/256 of a pixel: closer to an edge than that, either answer is right.
            if (std::abs(depth) < 1.0 / 64) continue;
            const bool inside = depth > 0;
            const std::uint8_t* pixel =
                &pixels[4 * (static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x))];
            ASSERT_EQ(pixel[0], inside ? 255 : 0) << x << " " << y;
            ASSERT_EQ(pixel[1], inside ? 0 : 255) << x << " " << y;
            covered += inside ? 1 : 0;
        }
    }
    EXPECT_GT(covered, 500);
}

/// A triangle in a picture of 64 × 64, by whatever pipeline and draw.
class TriangleTest : public DrawingTest {
  protected:
    GraphicsPipelinePtr pipeline(bool tessellated) {
        GraphicsPipelineDesc desc;
        desc.name = "triangle";
        desc.vertex = shader(tessellated ? "patch.vert" : "triangle.vert", ShaderStage::Vertex);
        desc.pixel = shader("triangle.frag", ShaderStage::Pixel);
        if (tessellated) {
            desc.hull = shader("patch.tesc", ShaderStage::Hull);
            desc.domain = shader("patch.tese", ShaderStage::Domain);
            desc.topology = Topology::PatchList;
            desc.patchControlPoints = 3;
        }
        desc.attributes = {VertexAttribute{}};
        desc.vertexStride = sizeof(Point);
        desc.colourFormats = {Format::Rgba8Unorm};
        desc.blend = {BlendDesc{}};
        auto made = device->createGraphicsPipeline(desc);
        EXPECT_TRUE(made) << made.error().message();
        return made.value();
    }
    std::vector<std::uint8_t> draw(bool tessellated, const std::function<void(CommandList&)>& call) {
        const TexturePtr picture = target(64, Format::Rgba8Unorm, 1);
        // Points before the triangle, to be skipped.
        const BufferPtr vertices = buffer(
            std::vector<Point>{{}, {}, {-0.83f, 0.91f, 0.5f}, {0.37f, 0.53f, 0.5f}, {-0.61f, -0.71f, 0.5f}},
            Usage::Vertex);
        const GraphicsPipelinePtr drawn = pipeline(tessellated);
        EXPECT_EQ(submitError([&](CommandList& list) {
                      list.beginPass({"draw", {{picture, LoadOp::Clear, {0, 1, 0, 1}, {}}}, {}});
                      list.setPipeline(drawn);
                      list.setVertexBuffer(vertices, 0);
                      call(list);
                      list.endPass();
                  }),
                  "");
        return read<std::uint8_t>(picture);
    }
    std::vector<std::uint8_t> plain() {
        return draw(false, [](CommandList& list) { list.draw(3, 1, 2); });
    }
};

TEST_F(TriangleTest, IndirectAndIndexedDrawsAreDraws) {
    const std::vector<std::uint8_t> expected = plain();
    EXPECT_GT(std::ranges::count(expected, 255), 1000);
    // The arguments stand behind a word that is none.
    const BufferPtr arguments = buffer(std::vector<std::uint32_t>{99, 3, 1, 2, 0}, Usage::Indirect);
    EXPECT_EQ(draw(false, [&](CommandList& list) { list.drawIndirect(arguments, 4); }), expected);
    const BufferPtr indices = buffer(std::vector<std::uint32_t>{7, 0, 1, 2}, Usage::Index);
    EXPECT_EQ(draw(false,
                   [&](CommandList& list) {
                       list.setIndexBuffer(indices, 0);
                       list.drawIndexed(3, 1, 1, 2);
                   }),
              expected);
}

/// Cut into sixteen by hull and domain shaders, the triangle covers what it covers whole.
TEST_F(TriangleTest, TessellationCoversTheSamePixels) {
    const std::vector<std::uint8_t> expected = plain();
    const std::vector<std::uint8_t> cut = draw(true, [](CommandList& list) { list.draw(3, 1, 2); });
    ASSERT_EQ(cut.size(), expected.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < cut.size(); i += 4) different += cut[i] != expected[i] ? 1 : 0;
    // New corners on an edge round off it: pixels whose centre the edge passes may change sides.
    EXPECT_LE(different, 4u);
}

TEST_F(DrawingTest, AddingIntoSixteenBitsIsExact) {
    for (const std::uint32_t samples : {1u, 4u}) {
        GraphicsPipelineDesc desc;
        desc.name = "add";
        desc.vertex = shader("add.vert", ShaderStage::Vertex);
        desc.pixel = shader("add.frag", ShaderStage::Pixel);
        desc.colourFormats = {Format::Rgba16Unorm};
        desc.blend = {BlendDesc::additive()};
        desc.samples = samples;
        const auto pipeline = device->createGraphicsPipeline(desc);
        ASSERT_TRUE(pipeline) << pipeline.error().message();
        const TexturePtr sum = target(8, Format::Rgba16Unorm, samples);
        const TexturePtr resolved = samples > 1 ? target(8, Format::Rgba16Unorm, 1) : nullptr;
        const std::array<float, 4> amount = {37 / 65535.0f, 1 / 65535.0f, 0.5f, 655 / 65535.0f};
        EXPECT_EQ(submitError([&](CommandList& list) {
                      list.beginPass({"add", {{sum, LoadOp::Clear, {0, 0, 0, 0}, resolved}}, {}});
                      list.setPipeline(*pipeline);
                      list.setConstants(0, bytesOf(amount));
                      for (int i = 0; i < 100; ++i) list.draw(3);
                      list.endPass();
                  }),
                  "");
        const auto texels = read<std::uint16_t>(samples > 1 ? resolved : sum);
        for (std::size_t i = 0; i < texels.size(); i += 4) {
            ASSERT_EQ(texels[i], 3700);
            ASSERT_EQ(texels[i + 1], 100);
            ASSERT_EQ(texels[i + 2], 65535);
            ASSERT_EQ(texels[i + 3], 65500);
        }
    }
}

TEST_F(DrawingTest, PipelinesFitTheirTargets) {
    GraphicsPipelineDesc desc;
    desc.name = "add";
    desc.vertex = shader("add.vert", ShaderStage::Vertex);
    desc.pixel = shader("add.frag", ShaderStage::Pixel);
    desc.colourFormats = {Format::Rgba16Unorm};
    desc.blend = {BlendDesc{}};
    const auto pipeline = device->createGraphicsPipeline(desc).value();
    const TexturePtr other = target(8, Format::Rgba8Unorm, 1);
    EXPECT_THAT(submitError([&](CommandList& list) {
                    list.beginPass({"draw", {{other, LoadOp::Clear, {0, 0, 0, 0}, {}}}, {}});
                    list.setPipeline(pipeline);
                    list.setConstants(0, bytesOf(std::array<float, 4>{}));
                    list.draw(3);
                    list.endPass();
                }),
                testing::HasSubstr("made for other targets"));
}

}  // namespace
}  // namespace hairloom::gpu
