// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/random.h"
#include "tests/gpu/gpu_fixture.h"

namespace hairloom::gpu {
namespace {

TEST(Devices, AtLeastOneCanBeUsed) {
    const auto devices = listDevices();
    ASSERT_TRUE(devices) << devices.error().message();
    std::uint32_t index = 0;
    bool usable = false;
    for (const DeviceInfo& info : *devices) {
        EXPECT_EQ(info.index, index++);
        EXPECT_FALSE(info.name.empty());
        EXPECT_EQ(info.usable, info.unusableReason.empty());
        if (!info.usable) continue;
        usable = true;
        EXPECT_EQ(info.sampleCounts.front(), 1u);
        EXPECT_GE(info.maxSamples(), 4u);
        EXPECT_GE(info.maxBufferBytes, std::uint64_t{1} << 27u);
        EXPECT_GE(info.maxTextureSize, 4096u);
    }
    EXPECT_TRUE(usable);
}

TEST(Devices, WhatIsNotThereIsNamed) {
    DeviceOptions options;
    options.name = "no such card";
    auto device = createDevice(options);
    ASSERT_FALSE(device);
    EXPECT_NE(device.error().message().find("no such GPU"), std::string::npos);
    options.name.clear();
    options.index = 99;
    EXPECT_FALSE(createDevice(options));
    options.index = 0;
    EXPECT_TRUE(createDevice(options));
}

TEST(Devices, ResourcesMayOutliveTheDevice) {
    BufferPtr buffer;
    std::unique_ptr<CommandList> list;
    {
        auto device = createDevice();
        ASSERT_TRUE(device);
        BufferDesc desc;
        desc.size = 64;
        buffer = (*device)->createBuffer(desc).value();
        list = (*device)->createCommandList().value();
    }
    list.reset();
    buffer.reset();
}

TEST_F(GpuTest, BuffersKeepTheirContent) {
    Random random(3);
    for (const std::size_t count : {1u, 7u, 1000u, 3000000u}) {
        std::vector<std::uint32_t> content(count);
        for (auto& value : content) value = random.next();
        EXPECT_EQ(read<std::uint32_t>(buffer(content)), content);
    }
}

class RoundTrip : public GpuTest {
  protected:
    void expectRoundTrip(Format format) {
        Random random(4);
        TextureDesc desc;
        desc.name = "round trip";
        desc.width = 37;
        desc.height = 21;
        desc.format = format;
        std::vector<std::uint8_t> content(37 * 21 * bytesPerTexel(format));
        // No 0xff: a byte pattern that is not a number need not survive in float formats.
        for (auto& value : content) value = static_cast<std::uint8_t>(random.below(0x70));
        const auto texture = device->createTexture(desc, std::as_bytes(std::span(content)));
        ASSERT_TRUE(texture) << texture.error().message();
        EXPECT_EQ(read<std::uint8_t>(*texture), content);
    }
};

TEST_F(RoundTrip, TexturesKeepTheirContent) {
    for (const Format format : {Format::Rgba8Unorm, Format::Rgba16Unorm, Format::Rgba32Float})
        expectRoundTrip(format);
}

/// Rows of no whole number of words: Wine 8 loses all but the first through its Vulkan renderer
/// (docs/windows.md).
TEST_F(RoundTrip, OddRowSizesKeepTheirContent) {
    expectRoundTrip(Format::R8Unorm);
}

TEST_F(GpuTest, DescriptionsOutsideTheLimitsAreErrors) {
    BufferDesc b;
    b.name = "thing";
    EXPECT_FALSE(device->createBuffer(b));
    b.size = std::uint64_t{1} << 60u;
    const auto huge = device->createBuffer(b);
    ASSERT_FALSE(huge);
    EXPECT_NE(huge.error().message().find("thing"), std::string::npos);
    b.size = 16;
    const std::uint32_t word = 0;
    EXPECT_FALSE(device->createBuffer(b, bytesOf(word)));
    TextureDesc t;
    t.width = 0;
    EXPECT_FALSE(device->createTexture(t));
    t.width = 100000;
    t.height = 100000;
    EXPECT_FALSE(device->createTexture(t));
    t.width = t.height = 4;
    t.samples = 3;
    EXPECT_FALSE(device->createTexture(t));
    t.samples = 1;
    t.format = Format::Unknown;
    EXPECT_FALSE(device->createTexture(t));
    EXPECT_FALSE(device->createShader({"garbage", ShaderStage::Vertex, bytesOf(word), bytesOf(word)}));
    EXPECT_FALSE(device->createGraphicsPipeline({}));
    EXPECT_FALSE(device->createComputePipeline({}));
}

TEST_F(GpuTest, OneListIsOpenAtATime) {
    auto first = device->createCommandList();
    ASSERT_TRUE(first);
    EXPECT_FALSE(device->createCommandList());
    first->reset();
    EXPECT_TRUE(device->createCommandList());
}

}  // namespace
}  // namespace hairloom::gpu
