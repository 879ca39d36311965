// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/d3d11/device.h"

#include "core/gpu/checks.h"
#include "core/gpu/d3d11/adapters.h"
#include "core/gpu/d3d11/backend.h"
#include "core/gpu/d3d11/swap_chain.h"

namespace hairloom::gpu::d3d11 {

tl::unexpected<Error> Context::failed(HRESULT result, const std::string& what) {
    if (!meansLost(result)) return d3d11::failed(result, what);
    lost = true;
    const HRESULT why = device->GetDeviceRemovedReason();
    return d3d11::failed(FAILED(why) ? why : result, what);
}

Status Context::checkAlive() const {
    if (lost) return deviceLost(info);
    return {};
}

Result<std::unique_ptr<gpu::Device>> openDevice(std::uint32_t index, const DeviceInfo& info,
                                                const DeviceOptions& options) {
    const auto adapters = listAdapters();
    if (!adapters) return tl::unexpected(adapters.error());
    if (index >= adapters->size()) return fail("GPU '" + info.name + "' has gone");
    IDXGIAdapter1* adapter = (*adapters)[index].Get();
    auto context = std::make_shared<Context>();
    context->info = info;
    context->timeoutSeconds = options.timeoutSeconds;
    if (auto status = openDevice(adapter, options.validation && info.validates, *context); !status) {
        return tl::unexpected(status.error());
    }
    return std::unique_ptr<gpu::Device>(std::make_unique<DeviceImpl>(std::move(context)));
}

DeviceImpl::~DeviceImpl() {
    for (const auto& submission : running_) static_cast<void>(submission->wait());
}

void DeviceImpl::retire() {
    while (!running_.empty() && running_.front()->isDone()) running_.pop_front();
}

Result<BufferPtr> DeviceImpl::createBuffer(const BufferDesc& desc, std::span<const std::byte> content) {
    if (auto status = context_->checkAlive(); !status) return tl::unexpected(status.error());
    if (auto status = checkDesc(context_->info, desc, content.size()); !status)
        return tl::unexpected(status.error());
    auto buffer = BufferImpl::create(context_, desc, content);
    if (!buffer) return tl::unexpected(buffer.error());
    return BufferPtr(std::move(*buffer));
}

Result<TexturePtr> DeviceImpl::createTexture(const TextureDesc& desc, std::span<const std::byte> content) {
    if (auto status = context_->checkAlive(); !status) return tl::unexpected(status.error());
    if (auto status = checkDesc(context_->info, desc, content.size()); !status)
        return tl::unexpected(status.error());
    auto texture = TextureImpl::create(context_, desc, content);
    if (!texture) return tl::unexpected(texture.error());
    return TexturePtr(std::move(*texture));
}

Result<SamplerPtr> DeviceImpl::createSampler(const SamplerDesc& desc) {
    auto sampler = SamplerImpl::create(context_, desc);
    if (!sampler) return tl::unexpected(sampler.error());
    return SamplerPtr(std::move(*sampler));
}

Result<ShaderPtr> DeviceImpl::createShader(const ShaderDesc& desc) {
    auto shader = ShaderImpl::create(context_, desc);
    if (!shader) return tl::unexpected(shader.error());
    return ShaderPtr(std::move(*shader));
}

Result<GraphicsPipelinePtr> DeviceImpl::createGraphicsPipeline(const GraphicsPipelineDesc& desc) {
    return createPipeline(context_, desc);
}

Result<ComputePipelinePtr> DeviceImpl::createComputePipeline(const ComputePipelineDesc& desc) {
    return createPipeline(context_, desc);
}

Result<std::unique_ptr<SwapChain>> DeviceImpl::createSwapChain(const SwapChainDesc& desc) {
    if (auto status = context_->checkAlive(); !status) return tl::unexpected(status.error());
    return SwapChainImpl::create(context_, desc);
}

Result<std::unique_ptr<CommandList>> DeviceImpl::createCommandList() {
    if (auto status = context_->checkAlive(); !status) return tl::unexpected(status.error());
    if (*listOpen_) return anotherListIsOpen();
    retire();
    *listOpen_ = true;
    return std::unique_ptr<CommandList>(
        std::make_unique<CommandListImpl>(context_, [open = listOpen_] { *open = false; }));
}

Result<SubmissionPtr> DeviceImpl::submit(std::unique_ptr<CommandList> list) {
    if (auto status = context_->checkAlive(); !status) return tl::unexpected(status.error());
    if (list == nullptr) return fail("no command list to submit");
    auto recording = static_cast<CommandListImpl&>(*list).finish();
    if (!recording) return tl::unexpected(recording.error());
    // The CPU moves the rows of textures into read-back buffers; nothing may overtake it.
    for (const auto& earlier : running_) {
        if (!recording->fillsReadBack || !earlier->fillsReadBack()) continue;
        if (auto status = earlier->wait(); !status) return tl::unexpected(status.error());
    }
    auto submission = std::make_shared<SubmissionImpl>(context_);
    if (auto status = submission->start(std::move(*recording)); !status)
        return tl::unexpected(status.error());
    running_.push_back(submission);
    return SubmissionPtr(std::move(submission));
}

std::vector<std::string> DeviceImpl::validationMessages() const {
    std::vector<std::string> texts;
    if (!context_->messages) return texts;
    const UINT64 count = context_->messages->GetNumStoredMessages();
    for (UINT64 i = 0; i < count; ++i) {
        SIZE_T size = 0;
        context_->messages->GetMessage(i, nullptr, &size);
        std::vector<std::byte> memory(size);
        auto* message = reinterpret_cast<D3D11_MESSAGE*>(memory.data());
        if (FAILED(context_->messages->GetMessage(i, message, &size))) continue;
        if (message->Severity > D3D11_MESSAGE_SEVERITY_WARNING) continue;
        texts.emplace_back(message->pDescription, message->DescriptionByteLength);
    }
    return texts;
}

}  // namespace hairloom::gpu::d3d11
