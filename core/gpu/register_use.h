// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The resources that shaders declare, as a backend reads them from compiled code.

#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/gpu/device.h"

namespace hairloom::gpu {

enum class RegisterShape { Constants, Buffer, TypedBuffer, Texture, Sampler };

/// RegisterUse::elementBytes of a ByteAddressBuffer.
inline constexpr std::uint32_t kRawElements = ~std::uint32_t{0};

struct RegisterUse {
    ShaderRegister at;
    RegisterShape shape = RegisterShape::Constants;
    std::uint32_t elementBytes = 0;  ///< of a structured buffer; 0 where the compiled code does not tell
};

/// What all shaders of a pipeline declare, each register once.
class RegisterUses {
  public:
    /// Errors: a shader before declares one of the registers differently.
    Status add(std::span<const RegisterUse> more, const std::string& pipeline);
    std::span<const RegisterUse> all() const { return uses_; }
    std::span<const ShaderRegister> registers() const { return registers_; }

  private:
    std::vector<RegisterUse> uses_;
    std::vector<ShaderRegister> registers_;
};

/// A shader as backends derive theirs from it.
class CheckedShader : public Shader {
  public:
    ShaderStage stage = ShaderStage::Vertex;
    std::string name;
    std::vector<RegisterUse> uses;
};

/// What `binding` must hold for the register. `where` starts the error.
Status checkBinding(const RegisterUse& use, const Binding& binding, const std::string& where);

}  // namespace hairloom::gpu
