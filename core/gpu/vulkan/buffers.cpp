// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/resources.h"

namespace hairloom::gpu::vulkan {
namespace {

VkBufferUsageFlags usageFlags(const BufferDesc& desc) {
    VkBufferUsageFlags flags = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const bool typed = desc.typedFormat != Format::Unknown;
    // As storage on a software device: withConstantsInStorage().
    if (has(desc.usage, Usage::Constant))
        flags |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (has(desc.usage, Usage::ShaderRead)) {
        flags |= typed ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    }
    if (has(desc.usage, Usage::UnorderedAccess)) {
        flags |= typed ? VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    }
    if (has(desc.usage, Usage::Vertex)) flags |= VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    if (has(desc.usage, Usage::Index)) flags |= VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    if (has(desc.usage, Usage::Indirect)) flags |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    return flags;
}

}  // namespace

Result<std::shared_ptr<BufferImpl>> BufferImpl::create(const ContextPtr& context, const BufferDesc& desc,
                                                       MemoryUse use) {
    const std::string what = "creating buffer '" + desc.name + "' of " + std::to_string(desc.size) + " bytes";
    std::shared_ptr<BufferImpl> result(new BufferImpl(context, desc));
    auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = desc.size;
    info.usage = usageFlags(desc);
    VkResult r = vkCreateBuffer(context->device, &info, nullptr, &result->handle);
    if (r != VK_SUCCESS) return context->failed(r, what);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(context->device, result->handle, &needs);
    const auto memory = context->allocator.allocate(needs, use, false);
    if (!memory) return fail(what + ": " + memory.error().problem, memory.error().expected);
    result->memory = *memory;
    r = vkBindBufferMemory(context->device, result->handle, memory->block->memory, memory->offset);
    if (r != VK_SUCCESS) return context->failed(r, what);
    if (desc.typedFormat != Format::Unknown) {
        auto view = make<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
        view.buffer = result->handle;
        view.format = toVulkan(desc.typedFormat);
        view.range = VK_WHOLE_SIZE;
        r = vkCreateBufferView(context->device, &view, nullptr, &result->view);
        if (r != VK_SUCCESS) return context->failed(r, what);
    }
    return result;
}

BufferImpl::~BufferImpl() {
    vkDestroyBufferView(context_->device, view, nullptr);
    vkDestroyBuffer(context_->device, handle, nullptr);
    context_->allocator.release(memory);
}

}  // namespace hairloom::gpu::vulkan
