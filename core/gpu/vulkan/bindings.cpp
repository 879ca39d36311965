// SPDX-License-Identifier: GPL-3.0-or-later
// From bound registers to descriptor sets.
#include "core/gpu/vulkan/commands.h"

namespace hairloom::gpu::vulkan {
namespace {

constexpr std::uint32_t kSetsPerPool = 64;

bool isTexture(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

bool isWrite(std::uint32_t binding) {
    return binding >= kWriteShift;
}

}  // namespace

Result<Binding> CommandListImpl::stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) {
    const auto staged = stage(bytes);
    if (!staged) return tl::unexpected(staged.error());
    Binding binding = Binding::constants(slot, staged->buffer);
    binding.offset = staged->offset;
    binding.size = (bytes.size() + 15) / 16 * 16;
    return binding;
}

Result<VkDescriptorSet> CommandListImpl::allocateSet(VkDescriptorSetLayout layout) {
    Recording& r = *recording_;
    if (setsLeft_ == 0 && r.descriptorPoolsUsed < r.descriptorPools.size()) {
        ++r.descriptorPoolsUsed;
        setsLeft_ = kSetsPerPool;
    }
    if (setsLeft_ == 0) {
        constexpr VkDescriptorPoolSize kSizes[] = {
            {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 4 * kSetsPerPool},
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 16 * kSetsPerPool},
            {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 16 * kSetsPerPool},
            {VK_DESCRIPTOR_TYPE_SAMPLER, 4 * kSetsPerPool},
            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kSetsPerPool},
            {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 4 * kSetsPerPool},
            {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 4 * kSetsPerPool}};
        auto info = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
        info.maxSets = kSetsPerPool;
        info.poolSizeCount = static_cast<std::uint32_t>(std::size(kSizes));
        info.pPoolSizes = kSizes;
        VkDescriptorPool pool = VK_NULL_HANDLE;
        const VkResult result = vkCreateDescriptorPool(r.context->device, &info, nullptr, &pool);
        if (result != VK_SUCCESS) return r.context->failed(result, "binding resources");
        r.descriptorPools.push_back(pool);
        ++r.descriptorPoolsUsed;
        setsLeft_ = kSetsPerPool;
    }
    auto info = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorPool = r.descriptorPools[r.descriptorPoolsUsed - 1];
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = vkAllocateDescriptorSets(r.context->device, &info, &set);
    if (result != VK_SUCCESS) return r.context->failed(result, "binding resources");
    --setsLeft_;
    return set;
}

void CommandListImpl::useBinding(const Binding& binding, const ReflectedBinding& wanted,
                                 VkPipelineStageFlags2 stages) {
    if (wanted.type == VK_DESCRIPTOR_TYPE_SAMPLER) return;
    Use use;
    use.stages = stages;
    use.write = isWrite(wanted.binding);
    if (isTexture(wanted.type)) {
        use.access = use.write ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT
                               : VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        use.layout = use.write ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        return barriers_.use(static_cast<TextureImpl&>(*binding.texture), use);
    }
    use.access = wanted.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? VK_ACCESS_2_UNIFORM_READ_BIT
                 : use.write ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT
                             : VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    barriers_.use(static_cast<BufferImpl&>(*binding.buffer), use);
}

VkDescriptorSet CommandListImpl::makeSet(const PipelineCore& pipeline, VkPipelineStageFlags2 stages) {
    for (const ReflectedBinding& wanted : pipeline.bindings) {
        useBinding(bound(toRegister(wanted.binding)), wanted, stages);
    }
    if (set_ != VK_NULL_HANDLE) return set_;
    const auto set = allocateSet(pipeline.setLayout);
    if (!set) return wrong(set.error()), VK_NULL_HANDLE;
    std::vector<VkDescriptorBufferInfo> buffers(pipeline.bindings.size());
    std::vector<VkDescriptorImageInfo> images(pipeline.bindings.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (std::size_t i = 0; i < pipeline.bindings.size(); ++i) {
        const ReflectedBinding& wanted = pipeline.bindings[i];
        const Binding& binding = bound(toRegister(wanted.binding));
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = *set;
        write.dstBinding = wanted.binding;
        write.descriptorCount = 1;
        write.descriptorType = wanted.type;
        if (binding.sampler) images[i].sampler = static_cast<SamplerImpl&>(*binding.sampler).handle;
        if (binding.texture) {
            images[i].imageView = static_cast<TextureImpl&>(*binding.texture).view;
            images[i].imageLayout =
                isWrite(wanted.binding) ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        }
        if (binding.buffer) {
            auto& buffer = static_cast<BufferImpl&>(*binding.buffer);
            buffers[i] = {buffer.handle, binding.offset, binding.size == 0 ? VK_WHOLE_SIZE : binding.size};
            write.pTexelBufferView = &buffer.view;
        }
        write.pBufferInfo = &buffers[i];
        write.pImageInfo = &images[i];
        writes.push_back(write);
    }
    vkUpdateDescriptorSets(recording_->context->device, static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
    set_ = *set;
    return set_;
}

}  // namespace hairloom::gpu::vulkan
