// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/gpu/backend_device.h"
#include "core/gpu/vulkan/commands.h"

namespace hairloom::gpu::vulkan {

class SubmissionImpl final : public Submission {
  public:
    SubmissionImpl(ContextPtr context, std::weak_ptr<RecordingStore> store,
                   std::vector<std::unique_ptr<Recording>> recordings)
        : context_(std::move(context)), store_(std::move(store)), recordings_(std::move(recordings)) {}
    ~SubmissionImpl() override;
    Status start();
    bool isDone() override;
    Status wait() override;
    Result<std::vector<PassTime>> passTimes() override;

  private:
    void finish();
    ContextPtr context_;
    std::weak_ptr<RecordingStore> store_;                 // goes with the device
    std::vector<std::unique_ptr<Recording>> recordings_;  // the caller's list is the last
    std::vector<PassTime> times_;
    bool started_ = false;
    bool done_ = false;
};

class DeviceImpl final : public BackendDevice {
  public:
    static Result<std::unique_ptr<gpu::Device>> create(std::uint32_t index, const DeviceInfo& info,
                                                       const DeviceOptions& options);
    explicit DeviceImpl(ContextPtr context)
        : context_(std::move(context)), store_(std::make_shared<RecordingStore>(context_)) {}
    ~DeviceImpl() override;

    const DeviceInfo& info() const override { return context_->info; }
    Result<SamplerPtr> createSampler(const SamplerDesc& desc) override;
    Result<ShaderPtr> createShader(const ShaderDesc& desc) override;
    Result<GraphicsPipelinePtr> createGraphicsPipeline(const GraphicsPipelineDesc& desc) override;
    Result<ComputePipelinePtr> createComputePipeline(const ComputePipelineDesc& desc) override;
    std::vector<std::string> validationMessages() const override { return context_->instance->messages(); }

  private:
    Result<BufferPtr> makeBuffer(const BufferDesc& desc, std::span<const std::byte> content) override;
    Result<TexturePtr> makeTexture(const TextureDesc& desc, std::span<const std::byte> content) override;
    Result<std::unique_ptr<SwapChain>> makeSwapChain(const SwapChainDesc& desc) override;
    Result<std::unique_ptr<CommandList>> makeCommandList(std::function<void()> whenClosed) override;
    Result<SubmissionPtr> start(CommandList& list) override;
    Status copyMapped(const Buffer& buffer, std::uint64_t offset, std::span<std::byte> target) override;
    Status checkAlive() const override { return context_->checkAlive(); }
    Status upload(const std::function<void(CommandListImpl&)>& record);
    Status flushUploads();
    Result<SubmissionPtr> run(std::vector<std::unique_ptr<Recording>> recordings);

    ContextPtr context_;
    std::shared_ptr<RecordingStore> store_;
    std::unique_ptr<CommandListImpl> uploads_;
};

}  // namespace hairloom::gpu::vulkan
