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

Usage neededUsage(Binding::Kind kind) {
    switch (kind) {
        case Binding::Kind::ConstantBuffer:
            return Usage::Constant;
        case Binding::Kind::ShaderResource:
            return Usage::ShaderRead;
        case Binding::Kind::Sampler:
            return Usage::None;
        case Binding::Kind::UnorderedAccess:
            break;
    }
    return Usage::UnorderedAccess;
}

}  // namespace

void CommandListImpl::bind(std::span<const Binding> bindings) {
    if (pass_ == PassKind::None) return wrong("bind outside a pass");
    for (const Binding& binding : bindings) {
        bound_[toBinding({binding.kind, binding.slot})] = binding;
        if (binding.buffer) static_cast<void>(keep(binding.buffer));
        if (binding.texture) static_cast<void>(keep(binding.texture));
        if (binding.sampler) keep(binding.sampler);
    }
    set_ = VK_NULL_HANDLE;
}

void CommandListImpl::setConstants(std::uint32_t slot, std::span<const std::byte> bytes) {
    if (bytes.empty() || bytes.size() > 65536) return wrong("constants of 1 to 65536 bytes are possible");
    const auto staged = stage(bytes);
    if (!staged) return wrong(staged.error());
    Binding binding = Binding::constants(slot, staged->buffer);
    binding.offset = staged->offset;
    binding.size = (bytes.size() + 15) / 16 * 16;
    bind({&binding, 1});
}

Result<VkDescriptorSet> CommandListImpl::allocateSet(VkDescriptorSetLayout layout) {
    Recording& r = *recording_;
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
        setsLeft_ = kSetsPerPool;
    }
    auto info = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorPool = r.descriptorPools.back();
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = vkAllocateDescriptorSets(r.context->device, &info, &set);
    if (result != VK_SUCCESS) return r.context->failed(result, "binding resources");
    --setsLeft_;
    return set;
}

bool CommandListImpl::useBinding(const Binding& binding, const ReflectedBinding& wanted,
                                 VkPipelineStageFlags2 stages, const std::string& where) {
    const bool sampler = wanted.type == VK_DESCRIPTOR_TYPE_SAMPLER;
    if (sampler) {
        if (binding.sampler == nullptr) wrong(where + " needs a sampler");
        return binding.sampler != nullptr;
    }
    const Usage usage = neededUsage(binding.kind);
    Use use;
    use.stages = stages;
    use.write = isWrite(wanted.binding);
    if (isTexture(wanted.type)) {
        if (binding.texture == nullptr) return wrong(where + " needs a texture"), false;
        if (!has(binding.texture->desc().usage, usage)) {
            return wrong(where + ": texture '" + binding.texture->desc().name + "' lacks this usage"), false;
        }
        use.access = use.write ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT
                               : VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
        use.layout = use.write ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        barriers_.use(static_cast<TextureImpl&>(*binding.texture), use);
        return true;
    }
    if (binding.buffer == nullptr) return wrong(where + " needs a buffer"), false;
    const BufferDesc& desc = binding.buffer->desc();
    const bool typed = wanted.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
                       wanted.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    if (!has(desc.usage, usage)) return wrong(where + ": buffer '" + desc.name + "' lacks this usage"), false;
    if (typed != (desc.typedFormat != Format::Unknown)) {
        return wrong(where + ": buffer '" + desc.name + "' is typed and the register is not, or the reverse"),
               false;
    }
    if (binding.offset % 256 != 0 || binding.offset >= desc.size ||
        binding.size > desc.size - binding.offset) {
        return wrong(where + ": range outside buffer '" + desc.name + "'"), false;
    }
    use.access = wanted.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ? VK_ACCESS_2_UNIFORM_READ_BIT
                 : use.write ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT
                             : VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    barriers_.use(static_cast<BufferImpl&>(*binding.buffer), use);
    return true;
}

VkDescriptorSet CommandListImpl::makeSet(const PipelineCore& pipeline, VkPipelineStageFlags2 stages) {
    for (const ReflectedBinding& wanted : pipeline.bindings) {
        const std::string where =
            "register " + toString(toRegister(wanted.binding)) + " of pipeline '" + pipeline.name + "'";
        const auto found = bound_.find(wanted.binding);
        if (found == bound_.end()) return wrong(where + " is not bound"), VK_NULL_HANDLE;
        if (!useBinding(found->second, wanted, stages, where)) return VK_NULL_HANDLE;
    }
    if (set_ != VK_NULL_HANDLE) return set_;
    const auto set = allocateSet(pipeline.setLayout);
    if (!set) return wrong(set.error()), VK_NULL_HANDLE;
    std::vector<VkDescriptorBufferInfo> buffers(pipeline.bindings.size());
    std::vector<VkDescriptorImageInfo> images(pipeline.bindings.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (std::size_t i = 0; i < pipeline.bindings.size(); ++i) {
        const ReflectedBinding& wanted = pipeline.bindings[i];
        const Binding& binding = bound_.at(wanted.binding);
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
