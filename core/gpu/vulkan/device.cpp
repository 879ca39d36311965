// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/device.h"

#include <utility>

#include "core/gpu/checks.h"
#include "core/gpu/vulkan/backend.h"
#include "core/gpu/vulkan/swap_chain.h"

namespace hairloom::gpu::vulkan {
namespace {

constexpr std::uint64_t kUploadFlushBytes = std::uint64_t{64} << 20u;

Status openDevice(Context& context) {
    const int family = findQueueFamily(context.physical);
    context.queueFamily = static_cast<std::uint32_t>(family);
    const float priority = 1;
    auto queue = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = context.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    VkPhysicalDeviceFeatures offered;
    vkGetPhysicalDeviceFeatures(context.physical, &offered);
    auto f2 = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    auto f13 = make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    f2.pNext = &f13;
    f13.dynamicRendering = f13.synchronization2 = VK_TRUE;
    f13.subgroupSizeControl = f13.computeFullSubgroups = context.info.waves.maximum > 0 ? VK_TRUE : VK_FALSE;
    f2.features.tessellationShader = offered.tessellationShader;
    f2.features.depthClamp = offered.depthClamp;
    f2.features.fillModeNonSolid = offered.fillModeNonSolid;
    f2.features.pipelineStatisticsQuery = context.countsWork ? VK_TRUE : VK_FALSE;
    f2.features.independentBlend = offered.independentBlend;
    f2.features.sampleRateShading = offered.sampleRateShading;
    f2.features.fragmentStoresAndAtomics = offered.fragmentStoresAndAtomics;
    f2.features.vertexPipelineStoresAndAtomics = offered.vertexPipelineStoresAndAtomics;
    f2.features.shaderStorageImageWriteWithoutFormat = offered.shaderStorageImageWriteWithoutFormat;

    auto info = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.pNext = &f2;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    const char* swapChain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    if (context.info.presents) {
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &swapChain;
    }
    const VkResult r = vkCreateDevice(context.physical, &info, nullptr, &context.device);
    if (r != VK_SUCCESS) return failed(r, "opening GPU '" + context.info.name + "'");
    vkGetDeviceQueue(context.device, context.queueFamily, 0, &context.queue);
    context.allocator.init(context.physical, context.device);
    return {};
}

}  // namespace

Context::~Context() {
    if (device == VK_NULL_HANDLE) return;
    vkDeviceWaitIdle(device);
    allocator.destroy();
    vkDestroyDevice(device, nullptr);
}

tl::unexpected<Error> Context::failed(VkResult result, const std::string& what) {
    if (result == VK_ERROR_DEVICE_LOST) lost = true;
    return vulkan::failed(result, what);
}

Status Context::checkAlive() const {
    if (lost) return deviceLost(info);
    return {};
}

Result<std::unique_ptr<gpu::Device>> DeviceImpl::create(std::uint32_t index, const DeviceInfo& info,
                                                        const DeviceOptions& options) {
    auto context = std::make_shared<Context>();
    auto instance = Instance::create(options.validation);
    if (!instance) return tl::unexpected(instance.error());
    context->instance = std::move(*instance);
    const auto physical = context->instance->physicalDevices();
    if (!physical) return tl::unexpected(physical.error());
    if (index >= physical->size())
        return fail("GPU '" + info.name + "' has gone", "expected one of `devices`");
    context->info = info;
    context->physical = (*physical)[index];
    context->timeoutSeconds = options.timeoutSeconds;
    context->countsWork = options.statistics && info.statistics;
    if (auto status = openDevice(*context); !status) return tl::unexpected(status.error());
    return std::unique_ptr<gpu::Device>(std::make_unique<DeviceImpl>(std::move(context)));
}

Result<std::unique_ptr<gpu::Device>> openDevice(std::uint32_t index, const DeviceInfo& info,
                                                const DeviceOptions& options) {
    return DeviceImpl::create(index, info, options);
}

DeviceImpl::~DeviceImpl() {
    uploads_.reset();
    waitForAll();
}

Status DeviceImpl::upload(const std::function<void(CommandListImpl&)>& record) {
    if (uploads_ == nullptr) {
        auto list = CommandListImpl::create(*store_, {});
        if (!list) return tl::unexpected(list.error());
        uploads_ = std::move(*list);
    }
    record(*uploads_);
    // The resource is new: no other list can have an opinion about its state yet.
    uploads_->commit();
    return uploads_->stagedBytes() > kUploadFlushBytes ? flushUploads() : Status{};
}

Status DeviceImpl::flushUploads() {
    if (uploads_ == nullptr) return {};
    auto recording = std::exchange(uploads_, nullptr)->finish();
    if (!recording) return tl::unexpected(recording.error());
    std::vector<std::unique_ptr<Recording>> recordings;
    recordings.push_back(std::move(*recording));
    const auto submission = run(std::move(recordings));
    if (!submission) return tl::unexpected(submission.error());
    return {};
}

Result<BufferPtr> DeviceImpl::makeBuffer(const BufferDesc& desc, std::span<const std::byte> content) {
    const MemoryUse use = desc.memory == MemoryKind::ReadBack ? MemoryUse::ReadBack : MemoryUse::DeviceLocal;
    auto buffer = BufferImpl::create(context_, desc, use);
    if (!buffer) return tl::unexpected(buffer.error());
    if (!content.empty()) {
        auto status = upload([&](CommandListImpl& list) { list.updateBuffer(*buffer, 0, content); });
        if (!status) return tl::unexpected(status.error());
    }
    return BufferPtr(std::move(*buffer));
}

Result<TexturePtr> DeviceImpl::makeTexture(const TextureDesc& desc, std::span<const std::byte> content) {
    auto texture = TextureImpl::create(context_, desc);
    if (!texture) return tl::unexpected(texture.error());
    if (!content.empty()) {
        auto status = upload([&](CommandListImpl& list) { list.updateTexture(*texture, content); });
        if (!status) return tl::unexpected(status.error());
    }
    return TexturePtr(std::move(*texture));
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
    return CommandListImpl::create(*store_, std::move(whenClosed));
}

Result<SubmissionPtr> DeviceImpl::start(CommandList& list) {
    auto& impl = static_cast<CommandListImpl&>(list);
    auto recording = impl.finish();
    if (!recording) return tl::unexpected(recording.error());
    std::vector<std::unique_ptr<Recording>> recordings;
    if (uploads_ != nullptr) {
        auto uploads = std::exchange(uploads_, nullptr)->finish();
        if (!uploads) return tl::unexpected(uploads.error());
        recordings.push_back(std::move(*uploads));
    }
    recordings.push_back(std::move(*recording));
    auto submission = run(std::move(recordings));
    if (submission) impl.commit();
    return submission;
}

Result<SubmissionPtr> DeviceImpl::run(std::vector<std::unique_ptr<Recording>> recordings) {
    auto submission = std::make_shared<SubmissionImpl>(context_, store_, std::move(recordings));
    if (auto status = submission->start(); !status) return tl::unexpected(status.error());
    return keep(std::move(submission));
}

}  // namespace hairloom::gpu::vulkan
