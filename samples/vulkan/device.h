// SPDX-License-Identifier: MIT
#pragma once
// A Vulkan 1.3 device without a screen, and its memory: nothing of hair.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

#include "../gpu_host.h"

constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_SRGB, kDepth = VK_FORMAT_D32_SFLOAT;

inline void check(VkResult result, const char* what) {
    if (result != VK_SUCCESS) fail(std::string(what) + ": VkResult " + std::to_string(result));
}

struct Buffer {
    VkBuffer handle;
    void* mapped;
    std::size_t bytes;
};
struct Image {
    VkImage handle;
    VkImageView view;
};

/// A device without a screen. What it makes lives as long as the program.
struct Gpu {
    VkPhysicalDevice physical{};
    VkDevice device{};
    VkQueue queue{};
    std::uint32_t family = 0;
    VkCommandBuffer commands{};

    Gpu() {
        VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
        application.apiVersion = VK_API_VERSION_1_3;
        VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
        info.pApplicationInfo = &application;
        VkInstance instance;
        check(vkCreateInstance(&info, nullptr, &instance), "no Vulkan");
        std::uint32_t count = 1;
        vkEnumeratePhysicalDevices(instance, &count, &physical);
        if (count == 0) fail("no Vulkan device");
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(physical, &properties);
        if (properties.apiVersion < VK_API_VERSION_1_3) fail("the device has no Vulkan 1.3");
        count = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
        std::vector<VkQueueFamilyProperties> families(count);
        vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
        constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        while (family < count && (families[family].queueFlags & kBoth) != kBoth) ++family;
        if (family == count) fail("the device has no queue that draws and computes");
        const float priority = 1;
        VkDeviceQueueCreateInfo queues{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queues.queueFamilyIndex = family;
        queues.queueCount = 1;
        queues.pQueuePriorities = &priority;
        VkPhysicalDeviceVulkan13Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
        features.dynamicRendering = VK_TRUE;
        // HLSL's discard keeps the rest of a quad running.
        features.shaderDemoteToHelperInvocation = VK_TRUE;
        VkDeviceCreateInfo made{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
        made.pNext = &features;
        made.queueCreateInfoCount = 1;
        made.pQueueCreateInfos = &queues;
        check(vkCreateDevice(physical, &made, nullptr, &device), "vkCreateDevice");
        vkGetDeviceQueue(device, family, 0, &queue);
        VkCommandPoolCreateInfo pools{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        pools.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        pools.queueFamilyIndex = family;
        VkCommandPool pool;
        check(vkCreateCommandPool(device, &pools, nullptr, &pool), "vkCreateCommandPool");
        VkCommandBufferAllocateInfo wanted{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        wanted.commandPool = pool;
        wanted.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device, &wanted, &commands), "vkAllocateCommandBuffers");
    }

    VkDeviceMemory memory(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) const {
        VkPhysicalDeviceMemoryProperties all;
        vkGetPhysicalDeviceMemoryProperties(physical, &all);
        VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        info.allocationSize = needs.size;
        while (info.memoryTypeIndex < all.memoryTypeCount &&
               ((needs.memoryTypeBits >> info.memoryTypeIndex & 1u) == 0 ||
                (all.memoryTypes[info.memoryTypeIndex].propertyFlags & flags) != flags))
            ++info.memoryTypeIndex;
        if (info.memoryTypeIndex == all.memoryTypeCount) fail("the device has no such memory");
        VkDeviceMemory memory;
        check(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
        return memory;
    }
    /// In memory that both see, which keeps this short. A game puts what is filled once, and what passes
    /// alone touch, where the GPU is quickest.
    Buffer buffer(std::size_t bytes, VkBufferUsageFlags usage) const {
        VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        info.size = bytes;
        info.usage = usage;
        Buffer made{{}, nullptr, bytes};
        check(vkCreateBuffer(device, &info, nullptr, &made.handle), "vkCreateBuffer");
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device, made.handle, &needs);
        constexpr VkMemoryPropertyFlags kSeen =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        VkDeviceMemory held = memory(needs, kSeen);
        check(vkBindBufferMemory(device, made.handle, held, 0), "vkBindBufferMemory");
        check(vkMapMemory(device, held, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
        return made;
    }
    Image image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) const {
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {kWidth, kHeight, 1};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = usage;
        Image made{};
        check(vkCreateImage(device, &info, nullptr, &made.handle), "vkCreateImage");
        VkMemoryRequirements needs;
        vkGetImageMemoryRequirements(device, made.handle, &needs);
        check(vkBindImageMemory(device, made.handle, memory(needs, 0), 0), "vkBindImageMemory");
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = made.handle;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format;
        view.subresourceRange = {aspect, 0, 1, 0, 1};
        check(vkCreateImageView(device, &view, nullptr, &made.view), "vkCreateImageView");
        return made;
    }
    VkPipelineShaderStageCreateInfo stage(const std::string& file, VkShaderStageFlagBits at) const {
        std::size_t size = 0;
        const std::vector<Piece> code = readFile(file, size);
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        info.codeSize = size;
        info.pCode = reinterpret_cast<const std::uint32_t*>(code.data());
        VkPipelineShaderStageCreateInfo made{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        made.stage = at;
        made.pName = "main";
        check(vkCreateShaderModule(device, &info, nullptr, &made.module), "vkCreateShaderModule");
        return made;
    }
};

inline void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkPipelineStageFlags to) {
    VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    all.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &all, 0, nullptr, 0, nullptr);
}
inline void turnInto(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                     VkImageLayout to) {
    VkImageMemoryBarrier turn{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    turn.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    turn.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    turn.oldLayout = from;
    turn.newLayout = to;
    turn.srcQueueFamilyIndex = turn.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    turn.image = image;
    turn.subresourceRange = {aspect, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                         0, nullptr, 0, nullptr, 1, &turn);
}
