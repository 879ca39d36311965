// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A small sub-allocator: blocks of 32 MiB per memory type, larger requests get memory of their own.

#include <cstddef>
#include <list>
#include <memory>

#include "core/gpu/vulkan/api.h"
#include "core/gpu/vulkan/free_list.h"

namespace hairloom::gpu::vulkan {

enum class MemoryUse { DeviceLocal, Upload, ReadBack };

struct MemoryBlock {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::uint32_t type = 0;
    bool images = false;
    bool dedicated = false;
    std::byte* mapped = nullptr;
    FreeList free{0};
};

struct Allocation {
    MemoryBlock* block = nullptr;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::byte* mapped() const { return block->mapped == nullptr ? nullptr : block->mapped + offset; }
};

class Allocator {
  public:
    void init(VkPhysicalDevice physical, VkDevice device);
    void destroy();
    /// Images and buffers come from different blocks, so that no granularity between the two has to be kept.
    Result<Allocation> allocate(const VkMemoryRequirements& needs, MemoryUse use, bool image);
    void release(const Allocation& allocation);

  private:
    Result<std::uint32_t> chooseType(std::uint32_t typeBits, MemoryUse use) const;
    Result<MemoryBlock*> addBlock(std::uint64_t size, std::uint32_t type, MemoryUse use, bool image);

    VkDevice device_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties properties_{};
    std::list<MemoryBlock> blocks_;
};

}  // namespace hairloom::gpu::vulkan
