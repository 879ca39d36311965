// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a compiled shader (DXBC) says about itself: the resources it uses, and the inputs of a vertex shader.

#include "core/gpu/register_use.h"

namespace hairloom::gpu::d3d11 {

struct VertexInput {
    std::string semantic;  ///< "POSITION"
    std::uint32_t semanticIndex = 0;
};

struct Reflection {
    std::vector<RegisterUse> registers;
    std::vector<VertexInput> inputs;  ///< in the order of declaration, without those that the system makes
};

/// Errors: not DXBC, damaged, or with a resource that the interface has no word for.
Result<Reflection> reflect(std::span<const std::byte> code);

}  // namespace hairloom::gpu::d3d11
