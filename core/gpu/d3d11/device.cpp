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
    if (index >= adapters->size())
        return fail("GPU '" + info.name + "' has gone", "expected one of `devices`");
    IDXGIAdapter1* adapter = (*adapters)[index].Get();
    auto context = std::make_shared<Context>();
    context->info = info;
    context->timeoutSeconds = options.timeoutSeconds;
    context->countsWork = options.statistics;
    if (auto status = openDevice(adapter, options.validation && info.validates, *context); !status) {
        return tl::unexpected(status.error());
    }
    return std::unique_ptr<gpu::Device>(std::make_unique<DeviceImpl>(std::move(context)));
}

Result<BufferPtr> DeviceImpl::makeBuffer(const BufferDesc& desc, std::span<const std::byte> content) {
    return BufferImpl::create(context_, desc, content);
}

Result<TexturePtr> DeviceImpl::makeTexture(const TextureDesc& desc, std::span<const std::byte> content) {
    return TextureImpl::create(context_, desc, content);
}

Result<SamplerPtr> DeviceImpl::createSampler(const SamplerDesc& desc) {
    return SamplerImpl::create(context_, desc);
}

Result<ShaderPtr> DeviceImpl::createShader(const ShaderDesc& desc) {
    return ShaderImpl::create(context_, desc);
}

Result<GraphicsPipelinePtr> DeviceImpl::createGraphicsPipeline(const GraphicsPipelineDesc& desc) {
    return createPipeline(context_, desc);
}

Result<ComputePipelinePtr> DeviceImpl::createComputePipeline(const ComputePipelineDesc& desc) {
    return createPipeline(context_, desc);
}

Result<std::unique_ptr<SwapChain>> DeviceImpl::makeSwapChain(const SwapChainDesc& desc) {
    return SwapChainImpl::create(context_, desc);
}

Result<std::unique_ptr<CommandList>> DeviceImpl::makeCommandList(std::function<void()> whenClosed) {
    return std::make_unique<CommandListImpl>(context_, std::move(whenClosed));
}

Result<SubmissionPtr> DeviceImpl::start(CommandList& list) {
    auto recording = static_cast<CommandListImpl&>(list).finish();
    if (!recording) return tl::unexpected(recording.error());
    // The CPU moves the rows of textures into read-back buffers; nothing may overtake it.
    const bool fillsReadBack = recording->fillsReadBack;
    if (fillsReadBack && lastReadBack_ != nullptr) {
        if (auto status = lastReadBack_->wait(); !status) return tl::unexpected(status.error());
    }
    auto submission = std::make_shared<SubmissionImpl>(context_);
    if (auto status = submission->start(std::move(*recording)); !status)
        return tl::unexpected(status.error());
    if (fillsReadBack) lastReadBack_ = submission;
    return keep(std::move(submission));
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
