// SPDX-License-Identifier: GPL-3.0-or-later
// Textures, samplers and formats.
#include "core/gpu/vulkan/resources.h"

namespace hairloom::gpu::vulkan {

VkFormat toVulkan(Format format) {
    switch (format) {
        case Format::Unknown:
            return VK_FORMAT_UNDEFINED;
        case Format::R8Unorm:
            return VK_FORMAT_R8_UNORM;
        case Format::Rgba8Unorm:
            return VK_FORMAT_R8G8B8A8_UNORM;
        case Format::Rgba8UnormSrgb:
            return VK_FORMAT_R8G8B8A8_SRGB;
        case Format::Bgra8Unorm:
            return VK_FORMAT_B8G8R8A8_UNORM;
        case Format::Rgba16Unorm:
            return VK_FORMAT_R16G16B16A16_UNORM;
        case Format::Rgba16Float:
            return VK_FORMAT_R16G16B16A16_SFLOAT;
        case Format::R32Uint:
            return VK_FORMAT_R32_UINT;
        case Format::R32Float:
            return VK_FORMAT_R32_SFLOAT;
        case Format::Rg32Float:
            return VK_FORMAT_R32G32_SFLOAT;
        case Format::Rgb32Float:
            return VK_FORMAT_R32G32B32_SFLOAT;
        case Format::Rgba32Float:
            return VK_FORMAT_R32G32B32A32_SFLOAT;
        case Format::D32Float:
            return VK_FORMAT_D32_SFLOAT;
    }
    return VK_FORMAT_UNDEFINED;
}

VkImageAspectFlags TextureImpl::aspect() const {
    return desc().format == Format::D32Float ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Result<std::shared_ptr<TextureImpl>> TextureImpl::create(const ContextPtr& context, const TextureDesc& desc) {
    const std::string what = "creating texture '" + desc.name + "' of " + std::to_string(desc.width) + "x" +
                             std::to_string(desc.height);
    std::shared_ptr<TextureImpl> result(new TextureImpl(context, desc));
    auto info = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = toVulkan(desc.format);
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = static_cast<VkSampleCountFlagBits>(desc.samples);
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (has(desc.usage, Usage::ShaderRead)) info.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    if (has(desc.usage, Usage::UnorderedAccess)) info.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (has(desc.usage, Usage::RenderTarget)) info.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (has(desc.usage, Usage::DepthStencil)) info.usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    VkImageFormatProperties limits;
    VkResult r = vkGetPhysicalDeviceImageFormatProperties(context->physical, info.format, info.imageType,
                                                          info.tiling, info.usage, 0, &limits);
    if (r != VK_SUCCESS || (limits.sampleCounts & desc.samples) == 0) {
        return fail(what + ": the device has no such combination of format, usage and samples",
                    "expected another device, or fewer samples (--aa)");
    }
    r = vkCreateImage(context->device, &info, nullptr, &result->handle);
    if (r != VK_SUCCESS) return context->failed(r, what);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(context->device, result->handle, &needs);
    const auto memory = context->allocator.allocate(needs, MemoryUse::DeviceLocal, true);
    if (!memory) return fail(what + ": " + memory.error().problem, memory.error().expected);
    result->memory = *memory;
    r = vkBindImageMemory(context->device, result->handle, memory->block->memory, memory->offset);
    if (r != VK_SUCCESS) return context->failed(r, what);
    auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = result->handle;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {result->aspect(), 0, 1, 0, 1};
    constexpr Usage kViewed =
        Usage::ShaderRead | Usage::UnorderedAccess | Usage::RenderTarget | Usage::DepthStencil;
    if (has(desc.usage, kViewed)) {
        r = vkCreateImageView(context->device, &view, nullptr, &result->view);
        if (r != VK_SUCCESS) return context->failed(r, what);
    }
    return result;
}

TextureImpl::~TextureImpl() {
    vkDestroyImageView(context_->device, view, nullptr);
    vkDestroyImage(context_->device, handle, nullptr);
    context_->allocator.release(memory);
}

Result<std::shared_ptr<SamplerImpl>> SamplerImpl::create(const ContextPtr& context, const SamplerDesc& desc) {
    std::shared_ptr<SamplerImpl> result(new SamplerImpl(context));
    auto info = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    info.magFilter = info.minFilter = desc.filter == Filter::Linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    info.mipmapMode =
        desc.filter == Filter::Linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    const VkSamplerAddressMode mode =
        desc.address == AddressMode::Clamp  ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE
        : desc.address == AddressMode::Wrap ? VK_SAMPLER_ADDRESS_MODE_REPEAT
                                            : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.addressModeU = info.addressModeV = info.addressModeW = mode;
    info.borderColor =
        desc.borderIsWhite ? VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE : VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    info.maxLod = VK_LOD_CLAMP_NONE;
    const VkResult r = vkCreateSampler(context->device, &info, nullptr, &result->handle);
    if (r != VK_SUCCESS) return context->failed(r, "creating a sampler");
    return result;
}

SamplerImpl::~SamplerImpl() {
    vkDestroySampler(context_->device, handle, nullptr);
}

}  // namespace hairloom::gpu::vulkan
