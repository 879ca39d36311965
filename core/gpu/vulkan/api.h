// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The only door to Vulkan's headers, and the small helpers that every file of the backend needs.

#include <volk.h>

#include <string>

#include "core/base/result.h"

namespace hairloom::gpu::vulkan {

/// A Vulkan structure with its type set and all else zero.
template <class T>
T make(VkStructureType type) {
    T value{};
    value.sType = type;
    return value;
}

std::string toString(VkResult result);

/// `what` completes "…: out of device memory" and the like.
tl::unexpected<Error> failed(VkResult result, const std::string& what);

}  // namespace hairloom::gpu::vulkan
