// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/engine_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/gpu/device.h"
#include "tests/documents/small_head.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

/// Says what it is told to be and cannot be used.
class NamedDevice : public gpu::Device {
  public:
    explicit NamedDevice(gpu::DeviceType type) {
        info_.name = "Example 9000";
        info_.type = type;
    }
    const gpu::DeviceInfo& info() const override { return info_; }
    gpu::Traffic traffic() const override { return {}; }
    Result<gpu::BufferPtr> createBuffer(const gpu::BufferDesc&, std::span<const std::byte>) override {
        return no();
    }
    Result<gpu::TexturePtr> createTexture(const gpu::TextureDesc&, std::span<const std::byte>) override {
        return no();
    }
    Result<gpu::SamplerPtr> createSampler(const gpu::SamplerDesc&) override { return no(); }
    Result<gpu::ShaderPtr> createShader(const gpu::ShaderDesc&) override { return no(); }
    Result<gpu::GraphicsPipelinePtr> createGraphicsPipeline(const gpu::GraphicsPipelineDesc&) override {
        return no();
    }
    Result<gpu::ComputePipelinePtr> createComputePipeline(const gpu::ComputePipelineDesc&) override {
        return no();
    }
    Result<std::unique_ptr<gpu::SwapChain>> createSwapChain(const gpu::SwapChainDesc&) override {
        return no();
    }
    Result<std::unique_ptr<gpu::CommandList>> createCommandList() override { return no(); }
    Result<gpu::SubmissionPtr> submit(std::unique_ptr<gpu::CommandList>) override { return no(); }
    Status readMapped(const gpu::BufferPtr&, std::uint64_t, std::span<std::byte>) override { return no(); }
    Status readBuffer(const gpu::BufferPtr&, std::uint64_t, std::span<std::byte>) override { return no(); }
    Status readTexture(const gpu::TexturePtr&, std::span<std::byte>) override { return no(); }
    std::vector<std::string> validationMessages() const override { return {}; }

  private:
    static tl::unexpected<Error> no() { return fail("this device does nothing"); }
    gpu::DeviceInfo info_;
};

class EngineChoiceTest : public testing::Test {
  protected:
    EngineChoice choose(EngineWish wish, gpu::Device* device, Result<EngineTimes> times) {
        return chooseEngine(wish, device, groom_, memory_, [&] {
            ++measured_;
            return times;
        });
    }

    TemporaryFolder folder_;
    EngineMemory memory_{folder_ / "engines.json"};
    Groom groom_ = smallHead();
    int measured_ = 0;
    NamedDevice gpu_{gpu::DeviceType::Discrete};
};

TEST_F(EngineChoiceTest, AutomaticMeasuresOnceAndTakesTheFaster) {
    const EngineChoice first = choose(EngineWish::automatic, &gpu_, EngineTimes{4, 0.5});
    EXPECT_EQ(first.kind, EngineKind::gpu);
    EXPECT_EQ(first.why, "0.50 ms per frame on Example 9000, 4.00 on the CPU");
    // Remembered, also by the next program.
    EXPECT_EQ(choose(EngineWish::automatic, &gpu_, EngineTimes{0.1, 0.5}), first);
    EXPECT_EQ(measured_, 1);
    groom_.interpolation.followPerGuide = 0;
    EXPECT_EQ(choose(EngineWish::automatic, &gpu_, EngineTimes{0.1, 0.5}).kind, EngineKind::cpu);
    EXPECT_EQ(measured_, 2);
}

TEST_F(EngineChoiceTest, SoftwareAndNothingAreTheCpu) {
    NamedDevice software(gpu::DeviceType::Cpu);
    EXPECT_EQ(choose(EngineWish::automatic, &software, EngineTimes{4, 1}),
              (EngineChoice{EngineKind::cpu, "Example 9000 is a software device"}));
    EXPECT_EQ(choose(EngineWish::gpu, &software, EngineTimes{4, 1}).kind, EngineKind::gpu);
    EXPECT_EQ(choose(EngineWish::gpu, nullptr, EngineTimes{4, 1}).kind, EngineKind::cpu);
    EXPECT_EQ(measured_, 0);
}

TEST_F(EngineChoiceTest, WhatCannotBeMeasuredIsTheCpuAndTriedAgain) {
    const EngineChoice choice = choose(EngineWish::automatic, &gpu_, fail("out of memory"));
    EXPECT_EQ(choice.kind, EngineKind::cpu);
    EXPECT_THAT(choice.why, testing::HasSubstr("out of memory"));
    EXPECT_EQ(choose(EngineWish::automatic, &gpu_, EngineTimes{4, 1}).kind, EngineKind::gpu);
}

TEST_F(EngineChoiceTest, SettingsWithoutKernelsAreTheCpu) {
    groom_.simulation.strandModel = runtime::StrandModel::springs;
    groom_.simulation.collisionSegments = true;
    const EngineChoice choice = choose(EngineWish::gpu, &gpu_, EngineTimes{4, 1});
    EXPECT_EQ(choice.kind, EngineKind::cpu);
    EXPECT_FALSE(choice.why.empty());
}

}  // namespace
}  // namespace hairloom
