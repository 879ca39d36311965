// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/memory.h"

#include <algorithm>

namespace hairloom::gpu::vulkan {
namespace {

constexpr std::uint64_t kBlockBytes = std::uint64_t{32} << 20u;

}  // namespace

void Allocator::init(VkPhysicalDevice physical, VkDevice device) {
    device_ = device;
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

void Allocator::destroy() {
    for (const MemoryBlock& block : blocks_) vkFreeMemory(device_, block.memory, nullptr);
    blocks_.clear();
}

Result<std::uint32_t> Allocator::chooseType(std::uint32_t typeBits, MemoryUse use) const {
    constexpr VkMemoryPropertyFlags kHost =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryPropertyFlags required = 0;
    VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (use != MemoryUse::DeviceLocal) required = wanted = kHost;
    if (use == MemoryUse::ReadBack) wanted |= VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    for (const VkMemoryPropertyFlags flags : {wanted, required}) {
        for (std::uint32_t i = 0; i < properties_.memoryTypeCount; ++i) {
            if ((typeBits >> i & 1u) == 0) continue;
            if ((properties_.memoryTypes[i].propertyFlags & flags) == flags) return i;
        }
    }
    return fail("the device has no memory type for this resource", "expected another device, or the CPU");
}

Result<MemoryBlock*> Allocator::addBlock(std::uint64_t size, std::uint32_t type, MemoryUse use, bool image) {
    auto info = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    MemoryBlock block;
    if (const VkResult r = vkAllocateMemory(device_, &info, nullptr, &block.memory); r != VK_SUCCESS) {
        return failed(r, "allocating " + std::to_string(size) + " bytes");
    }
    if (use != MemoryUse::DeviceLocal) {
        void* mapped = nullptr;
        if (const VkResult r = vkMapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
            r != VK_SUCCESS) {
            vkFreeMemory(device_, block.memory, nullptr);
            return failed(r, "mapping memory");
        }
        block.mapped = static_cast<std::byte*>(mapped);
    }
    block.type = type;
    block.images = image;
    block.free = FreeList(size);
    blocks_.push_back(std::move(block));
    return &blocks_.back();
}

Result<Allocation> Allocator::allocate(const VkMemoryRequirements& needs, MemoryUse use, bool image) {
    const auto type = chooseType(needs.memoryTypeBits, use);
    if (!type) return tl::unexpected(type.error());
    const bool dedicated = needs.size > kBlockBytes / 2;
    if (!dedicated) {
        for (MemoryBlock& block : blocks_) {
            const bool mapped = block.mapped != nullptr;
            if (block.dedicated || block.type != *type || block.images != image) continue;
            if (mapped != (use != MemoryUse::DeviceLocal)) continue;
            if (const auto offset = block.free.allocate(needs.size, needs.alignment)) {
                return Allocation{&block, *offset, needs.size};
            }
        }
    }
    auto block = addBlock(dedicated ? needs.size : kBlockBytes, *type, use, image);
    if (!block) return tl::unexpected(block.error());
    (*block)->dedicated = dedicated;
    const auto offset = (*block)->free.allocate(needs.size, needs.alignment);
    return Allocation{*block, offset.value_or(0), needs.size};
}

void Allocator::release(const Allocation& allocation) {
    if (allocation.block == nullptr) return;
    allocation.block->free.release(allocation.offset, allocation.size);
    if (!allocation.block->dedicated) return;
    vkFreeMemory(device_, allocation.block->memory, nullptr);
    blocks_.remove_if([&](const MemoryBlock& block) { return &block == allocation.block; });
}

}  // namespace hairloom::gpu::vulkan
