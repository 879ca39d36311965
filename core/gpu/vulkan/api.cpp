// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/api.h"

#include <fmt/format.h>

namespace hairloom::gpu::vulkan {

std::string toString(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "out of memory";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "out of device memory";
        case VK_ERROR_OUT_OF_POOL_MEMORY:
            return "out of descriptor memory";
        case VK_ERROR_DEVICE_LOST:
            return "the device is lost";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "the driver cannot be initialised";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "a layer is not installed";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "an extension is missing";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "a feature is missing";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "no compatible driver";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "too many objects";
        case VK_TIMEOUT:
            return "not finished in time";
        default:
            return fmt::format("Vulkan error {}", static_cast<int>(result));
    }
}

namespace {

std::string whatHelps(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "expected more memory, or less hair";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "expected a device with more memory, less hair, or the CPU";
        case VK_ERROR_DEVICE_LOST:
        case VK_TIMEOUT:
            return "expected a device that finishes its work: try again, another device, or the CPU";
        case VK_ERROR_INITIALIZATION_FAILED:
        case VK_ERROR_LAYER_NOT_PRESENT:
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "expected a driver of Vulkan 1.3 that is installed";
        default:
            return "expected what the device can do: try another device, or the CPU";
    }
}

}  // namespace

tl::unexpected<Error> failed(VkResult result, const std::string& what) {
    return fail(fmt::format("{}: {}", what, toString(result)), whatHelps(result));
}

}  // namespace hairloom::gpu::vulkan
