// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/gpu/backend_device.h"
#include "core/gpu/d3d11/commands.h"

namespace hairloom::gpu::d3d11 {

class SubmissionImpl final : public Submission {
  public:
    explicit SubmissionImpl(ContextPtr context) : context_(std::move(context)) {}
    Status start(Recording recording);
    bool isDone() override;
    Status wait() override;
    Result<std::vector<PassTime>> passTimes() override;

  private:
    Status finish();
    Status moveRows(const RowCopy& copy);
    Status createQuery(D3D11_QUERY kind, ComPtr<ID3D11Query>& query);

    ContextPtr context_;
    ComPtr<ID3D11Query> finished_, clock_;
    std::vector<PassQueries> passes_;
    std::vector<RowCopy> rowCopies_;
    std::vector<PassTime> times_;
    bool done_ = false;
};

class DeviceImpl final : public BackendDevice {
  public:
    explicit DeviceImpl(ContextPtr context) : context_(std::move(context)) {}
    ~DeviceImpl() override { waitForAll(); }

    const DeviceInfo& info() const override { return context_->info; }
    Result<SamplerPtr> createSampler(const SamplerDesc& desc) override;
    Result<ShaderPtr> createShader(const ShaderDesc& desc) override;
    Result<GraphicsPipelinePtr> createGraphicsPipeline(const GraphicsPipelineDesc& desc) override;
    Result<ComputePipelinePtr> createComputePipeline(const ComputePipelineDesc& desc) override;
    std::vector<std::string> validationMessages() const override;

  private:
    Result<BufferPtr> makeBuffer(const BufferDesc& desc, std::span<const std::byte> content) override;
    Result<TexturePtr> makeTexture(const TextureDesc& desc, std::span<const std::byte> content) override;
    Result<std::unique_ptr<SwapChain>> makeSwapChain(const SwapChainDesc& desc) override;
    Result<std::unique_ptr<CommandList>> makeCommandList(std::function<void()> whenClosed) override;
    Result<SubmissionPtr> start(CommandList& list) override;
    Status copyMapped(const Buffer& buffer, std::uint64_t offset, std::span<std::byte> target) override;
    Status checkAlive() const override { return context_->checkAlive(); }

    ContextPtr context_;
    std::shared_ptr<SubmissionImpl> lastReadBack_;  ///< the last that fills buffers of rows
};

}  // namespace hairloom::gpu::d3d11
