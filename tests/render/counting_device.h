// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/gpu/device.h"

namespace hairloom::render {

/// Passes everything on and counts what is created.
class CountingDevice final : public gpu::Device {
  public:
    explicit CountingDevice(gpu::Device& device) : device_(device) {}
    int created = 0;

    const gpu::DeviceInfo& info() const override { return device_.info(); }
    Result<gpu::BufferPtr> createBuffer(const gpu::BufferDesc& desc,
                                        std::span<const std::byte> content) override {
        ++created;
        return device_.createBuffer(desc, content);
    }
    Result<gpu::TexturePtr> createTexture(const gpu::TextureDesc& desc,
                                          std::span<const std::byte> content) override {
        ++created;
        return device_.createTexture(desc, content);
    }
    Result<gpu::SamplerPtr> createSampler(const gpu::SamplerDesc& desc) override {
        ++created;
        return device_.createSampler(desc);
    }
    Result<gpu::ShaderPtr> createShader(const gpu::ShaderDesc& desc) override {
        ++created;
        return device_.createShader(desc);
    }
    Result<gpu::GraphicsPipelinePtr> createGraphicsPipeline(const gpu::GraphicsPipelineDesc& desc) override {
        ++created;
        return device_.createGraphicsPipeline(desc);
    }
    Result<gpu::ComputePipelinePtr> createComputePipeline(const gpu::ComputePipelineDesc& desc) override {
        ++created;
        return device_.createComputePipeline(desc);
    }
    Result<std::unique_ptr<gpu::CommandList>> createCommandList() override {
        return device_.createCommandList();
    }
    Result<gpu::SubmissionPtr> submit(std::unique_ptr<gpu::CommandList> list) override {
        return device_.submit(std::move(list));
    }
    Status readMapped(const gpu::BufferPtr& buffer, std::uint64_t offset,
                      std::span<std::byte> target) override {
        return device_.readMapped(buffer, offset, target);
    }
    Status readBuffer(const gpu::BufferPtr& buffer, std::uint64_t offset,
                      std::span<std::byte> target) override {
        return device_.readBuffer(buffer, offset, target);
    }
    Status readTexture(const gpu::TexturePtr& texture, std::span<std::byte> target) override {
        return device_.readTexture(texture, target);
    }
    std::vector<std::string> validationMessages() const override { return device_.validationMessages(); }

  private:
    gpu::Device& device_;
};

}  // namespace hairloom::render
