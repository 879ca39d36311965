// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/d3d11/reflection.h"

#include <cstring>
#include <optional>

namespace hairloom::gpu::d3d11 {
namespace {

// The container: "DXBC", a checksum of 16 bytes, 1, the size, the number of chunks, their offsets. A chunk:
// four letters, its size, its data. Offsets inside a chunk count from the beginning of its data.
constexpr std::size_t kChunkCountAt = 28;
constexpr std::size_t kRegisterBytes = 32;
constexpr std::size_t kSignatureBytes = 24;
// D3D_SHADER_INPUT_TYPE
enum InputType : std::uint32_t {
    kConstantBuffer = 0,
    kTexture = 2,
    kSampler = 3,
    kTypedUnorderedAccess = 4,
    kStructured = 5,
    kStructuredUnorderedAccess = 6,
    kRaw = 7,
    kRawUnorderedAccess = 8
};
constexpr std::uint32_t kDimensionBuffer = 1;  // D3D_SRV_DIMENSION_BUFFER

using Bytes = std::span<const std::byte>;

std::optional<std::uint32_t> wordAt(Bytes bytes, std::size_t offset) {
    if (offset > bytes.size() || bytes.size() - offset < 4) return std::nullopt;
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, 4);
    return word;
}

/// A run of words at `offset`; empty when it does not fit.
std::vector<std::uint32_t> wordsAt(Bytes bytes, std::size_t offset, std::size_t count) {
    if (offset > bytes.size() || bytes.size() - offset < 4 * count) return {};
    std::vector<std::uint32_t> words(count);
    std::memcpy(words.data(), bytes.data() + offset, 4 * count);
    return words;
}

std::string textAt(Bytes bytes, std::size_t offset) {
    std::string text;
    for (; offset < bytes.size() && bytes[offset] != std::byte{0}; ++offset) {
        text += std::to_integer<char>(bytes[offset]);
    }
    return text;
}

Bytes findChunk(Bytes code, std::string_view letters) {
    const std::uint32_t count = wordAt(code, kChunkCountAt).value_or(0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto offset = wordAt(code, kChunkCountAt + 4 + std::size_t{4} * i);
        if (!offset) return {};
        const auto size = wordAt(code, std::size_t{*offset} + 4);
        if (!size || *size > code.size() - *offset - 8) return {};
        if (std::memcmp(code.data() + *offset, letters.data(), 4) == 0)
            return code.subspan(*offset + 8, *size);
    }
    return {};
}

Result<RegisterUse> registerUse(std::uint32_t type, std::uint32_t dimension, std::uint32_t samplesOrStride) {
    using Kind = Binding::Kind;
    switch (type) {
        case kConstantBuffer:
            return RegisterUse{{Kind::ConstantBuffer, 0}, RegisterShape::Constants, 0};
        case kSampler:
            return RegisterUse{{Kind::Sampler, 0}, RegisterShape::Sampler, 0};
        case kTexture:
        case kTypedUnorderedAccess: {
            const Kind kind = type == kTexture ? Kind::ShaderResource : Kind::UnorderedAccess;
            const bool buffer = dimension == kDimensionBuffer;
            return RegisterUse{{kind, 0}, buffer ? RegisterShape::TypedBuffer : RegisterShape::Texture, 0};
        }
        case kStructured:
            return RegisterUse{{Kind::ShaderResource, 0}, RegisterShape::Buffer, samplesOrStride};
        case kStructuredUnorderedAccess:
            return RegisterUse{{Kind::UnorderedAccess, 0}, RegisterShape::Buffer, samplesOrStride};
        case kRaw:
            return RegisterUse{{Kind::ShaderResource, 0}, RegisterShape::Buffer, kRawElements};
        case kRawUnorderedAccess:
            return RegisterUse{{Kind::UnorderedAccess, 0}, RegisterShape::Buffer, kRawElements};
        default:
            return fail("a resource of unknown type");
    }
}

Status readRegisters(Bytes chunk, std::vector<RegisterUse>& registers) {
    const auto head = wordsAt(chunk, 0, 4);
    if (head.empty()) return fail("truncated DXBC");
    for (std::size_t i = 0; i < head[2]; ++i) {
        // name, type, return type, dimension, samples or stride, first register, count, flags
        const auto words = wordsAt(chunk, head[3] + i * kRegisterBytes, kRegisterBytes / 4);
        if (words.empty()) return fail("truncated DXBC");
        if (words[6] != 1) return fail("an array of resources", "one resource a register");
        auto use = registerUse(words[1], words[3], words[4]);
        if (!use) return tl::unexpected(use.error());
        use->at.slot = words[5];
        registers.push_back(*use);
    }
    return {};
}

Status readInputs(Bytes chunk, std::vector<VertexInput>& inputs) {
    const auto count = wordAt(chunk, 0);
    if (!count) return fail("truncated DXBC");
    for (std::size_t i = 0; i < *count; ++i) {
        // name, index, what the system makes of it, component type, register, mask
        const auto words = wordsAt(chunk, 8 + i * kSignatureBytes, kSignatureBytes / 4);
        if (words.empty()) return fail("truncated DXBC");
        if (words[2] == 0) inputs.push_back({textAt(chunk, words[0]), words[1]});
    }
    return {};
}

}  // namespace

Result<Reflection> reflect(std::span<const std::byte> code) {
    if (code.size() < kChunkCountAt + 4 || std::memcmp(code.data(), "DXBC", 4) != 0) {
        return fail("not DXBC", "the letters DXBC");
    }
    Reflection result;
    if (auto status = readRegisters(findChunk(code, "RDEF"), result.registers); !status) {
        return tl::unexpected(status.error());
    }
    if (auto status = readInputs(findChunk(code, "ISGN"), result.inputs); !status) {
        return tl::unexpected(status.error());
    }
    return result;
}

}  // namespace hairloom::gpu::d3d11
