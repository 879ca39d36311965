// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "core/gpu/d3d11/commands.h"

namespace hairloom::gpu::d3d11 {

class SubmissionImpl final : public Submission {
  public:
    explicit SubmissionImpl(ContextPtr context) : context_(std::move(context)) {}
    Status start(Recording recording);
    bool isDone() override;
    Status wait() override;
    Result<std::vector<PassTime>> passTimes() override;
    bool fillsReadBack() const { return fillsReadBack_; }

  private:
    Status finish();
    Status moveRows(const RowCopy& copy);
    Status createQuery(D3D11_QUERY kind, ComPtr<ID3D11Query>& query);

    ContextPtr context_;
    ComPtr<ID3D11Query> finished_, clock_;
    std::vector<PassQueries> passes_;
    std::vector<RowCopy> rowCopies_;
    std::vector<PassTime> times_;
    bool fillsReadBack_ = false;
    bool done_ = false;
};

class DeviceImpl final : public gpu::Device {
  public:
    explicit DeviceImpl(ContextPtr context) : context_(std::move(context)) {}
    ~DeviceImpl() override;

    const DeviceInfo& info() const override { return context_->info; }
    Result<BufferPtr> createBuffer(const BufferDesc& desc, std::span<const std::byte> content) override;
    Result<TexturePtr> createTexture(const TextureDesc& desc, std::span<const std::byte> content) override;
    Result<SamplerPtr> createSampler(const SamplerDesc& desc) override;
    Result<ShaderPtr> createShader(const ShaderDesc& desc) override;
    Result<GraphicsPipelinePtr> createGraphicsPipeline(const GraphicsPipelineDesc& desc) override;
    Result<ComputePipelinePtr> createComputePipeline(const ComputePipelineDesc& desc) override;
    Result<std::unique_ptr<SwapChain>> createSwapChain(const SwapChainDesc& desc) override;
    Result<std::unique_ptr<CommandList>> createCommandList() override;
    Result<SubmissionPtr> submit(std::unique_ptr<CommandList> list) override;
    Status readMapped(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) override;
    Status readBuffer(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) override;
    Status readTexture(const TexturePtr& texture, std::span<std::byte> target) override;
    std::vector<std::string> validationMessages() const override;

  private:
    Result<BufferPtr> createReadBack(std::uint64_t size);
    Status runAndRead(const std::function<void(CommandList&, const BufferPtr&)>& record,
                      std::span<std::byte> target);
    void retire();

    ContextPtr context_;
    std::shared_ptr<bool> listOpen_ = std::make_shared<bool>(false);
    std::deque<std::shared_ptr<SubmissionImpl>> running_;
};

}  // namespace hairloom::gpu::d3d11
