// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which registers a SPIR-V module uses, read from its decorations. Binding numbers carry the HLSL register
// class: b# at 0, t# at 16, s# at 48, u# at 64 (the shifts given to the shader compiler).

#include <cstddef>
#include <span>
#include <vector>

#include "core/gpu/types.h"
#include "core/gpu/vulkan/api.h"

namespace hairloom::gpu::vulkan {

inline constexpr std::uint32_t kConstantShift = 0;
inline constexpr std::uint32_t kReadShift = 16;
inline constexpr std::uint32_t kSamplerShift = 48;
inline constexpr std::uint32_t kWriteShift = 64;

struct ReflectedBinding {
    std::uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    VkShaderStageFlags stages = 0;
};

ShaderRegister toRegister(std::uint32_t binding);

/// Errors: not SPIR-V, or a kind of resource that the interface does not have. Does not judge validity
/// otherwise.
Result<std::vector<ReflectedBinding>> reflect(std::span<const std::uint32_t> words, VkShaderStageFlags stage);

/// The module with its constant buffers as storage buffers that nobody writes, at the same bindings. Mesa's
/// software device (seen in 22.3) compiles a shader anew whenever it is bound or its constants change, for
/// the values of those that branches depend on, and keeps all it has compiled: seconds and megabytes with
/// each frame. Of storage it does not know the values. For modules that reflect() takes.
std::vector<std::uint32_t> withConstantsInStorage(std::span<const std::uint32_t> words);

}  // namespace hairloom::gpu::vulkan
