// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/register_use.h"

#include <algorithm>

namespace hairloom::gpu {
namespace {

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

Status checkBuffer(const RegisterUse& use, const Binding& binding, const std::string& where) {
    if (binding.buffer == nullptr) return fail(where + " needs a buffer");
    const BufferDesc& desc = binding.buffer->desc();
    if (!has(desc.usage, neededUsage(use.at.kind))) {
        return fail(where + ": buffer '" + desc.name + "' lacks this usage");
    }
    if ((use.shape == RegisterShape::TypedBuffer) != (desc.typedFormat != Format::Unknown)) {
        return fail(where + ": buffer '" + desc.name + "' is typed and the register is not, or the reverse");
    }
    const std::uint32_t elementBytes = use.elementBytes == kRawElements ? 0 : use.elementBytes;
    if (use.elementBytes != 0 && desc.elementBytes != elementBytes) {
        return fail(where + ": buffer '" + desc.name + "' has elements of " +
                    std::to_string(desc.elementBytes) + " bytes, the shader's have " +
                    std::to_string(elementBytes));
    }
    if (binding.offset % 256 != 0 || binding.offset >= desc.size ||
        binding.size > desc.size - binding.offset) {
        return fail(where + ": range outside buffer '" + desc.name + "'");
    }
    return {};
}

}  // namespace

Status RegisterUses::add(std::span<const RegisterUse> more, const std::string& pipeline) {
    for (const RegisterUse& use : more) {
        const auto same = std::ranges::find(uses_, use.at, &RegisterUse::at);
        if (same == uses_.end()) {
            uses_.push_back(use);
            registers_.push_back(use.at);
        } else if (same->shape != use.shape) {
            return fail("pipeline '" + pipeline +
                        "': its shaders see different kinds of resource at register " + toString(use.at));
        }
    }
    return {};
}

Status checkBinding(const RegisterUse& use, const Binding& binding, const std::string& where) {
    switch (use.shape) {
        case RegisterShape::Sampler:
            if (binding.sampler == nullptr) return fail(where + " needs a sampler");
            return {};
        case RegisterShape::Texture:
            if (binding.texture == nullptr) return fail(where + " needs a texture");
            if (!has(binding.texture->desc().usage, neededUsage(use.at.kind))) {
                return fail(where + ": texture '" + binding.texture->desc().name + "' lacks this usage");
            }
            return {};
        case RegisterShape::Constants:
        case RegisterShape::Buffer:
        case RegisterShape::TypedBuffer:
            break;
    }
    return checkBuffer(use, binding, where);
}

}  // namespace hairloom::gpu
