// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/gpu/register_use.h"

namespace hairloom::gpu {
namespace {

constexpr std::uint32_t kLargestElement = 2048;

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// A GPU before a software rasteriser; among GPUs the discrete one.
int rank(DeviceType type) {
    switch (type) {
        case DeviceType::Discrete:
            return 0;
        case DeviceType::Integrated:
            return 1;
        case DeviceType::Virtual:
            return 2;
        case DeviceType::Other:
            return 3;
        case DeviceType::Cpu:
            break;
    }
    return 4;
}

bool isStage(const ShaderPtr& shader, ShaderStage stage) {
    return shader == nullptr || static_cast<const CheckedShader&>(*shader).stage == stage;
}

/// Direct3D's rules of what a buffer can be at once, kept on every backend.
Status checkUsage(const BufferDesc& desc) {
    const auto wrong = [&](const std::string& what) { return fail("buffer '" + desc.name + "': " + what); };
    if (has(desc.usage, Usage::Constant) && desc.usage != Usage::Constant) {
        return wrong("a buffer of constants can be nothing else");
    }
    const bool structured =
        desc.elementBytes > 0 && has(desc.usage, Usage::ShaderRead | Usage::UnorderedAccess);
    if (structured && (desc.elementBytes % 4 != 0 || desc.elementBytes > kLargestElement)) {
        return wrong(fmt::format("elements of {} bytes; multiples of 4 up to {} are possible",
                                 desc.elementBytes, kLargestElement));
    }
    if (structured && has(desc.usage, Usage::Vertex | Usage::Index | Usage::Indirect)) {
        return wrong("a structured buffer cannot hold vertices, indices or arguments; leave elementBytes 0");
    }
    return {};
}

}  // namespace

Status checkDesc(const DeviceInfo& info, const BufferDesc& desc, std::size_t content) {
    const auto wrong = [&](const std::string& what) { return fail("buffer '" + desc.name + "': " + what); };
    if (desc.size == 0) return wrong("a size of 0 bytes");
    if (desc.size > info.maxBufferBytes) {
        return wrong(fmt::format("{} bytes, the device allows {}", desc.size, info.maxBufferBytes));
    }
    if (content != 0 && content != desc.size) return wrong("the content does not have the buffer's size");
    if (content != 0 && desc.memory == MemoryKind::ReadBack)
        return wrong("a read-back buffer has no first content");
    return checkUsage(desc);
}

Status checkDesc(const DeviceInfo& info, const TextureDesc& desc, std::size_t content) {
    const auto wrong = [&](const std::string& what) { return fail("texture '" + desc.name + "': " + what); };
    const std::uint32_t texel = bytesPerTexel(desc.format);
    if (texel == 0) return wrong("no format");
    if (desc.width == 0 || desc.height == 0 || desc.width > info.maxTextureSize ||
        desc.height > info.maxTextureSize) {
        return wrong(
            fmt::format("{}x{} pixels, 1 to {} are possible", desc.width, desc.height, info.maxTextureSize));
    }
    if (std::ranges::find(info.sampleCounts, desc.samples) == info.sampleCounts.end()) {
        return wrong(fmt::format("the device has no {} samples per pixel", desc.samples));
    }
    if (has(desc.usage, Usage::DepthStencil) != (desc.format == Format::D32Float) &&
        (has(desc.usage, Usage::DepthStencil) || has(desc.usage, Usage::RenderTarget))) {
        return wrong("depth formats are for depth targets, colour formats for colour targets");
    }
    if (content != 0 && (desc.samples != 1 || content != std::uint64_t{desc.width} * desc.height * texel)) {
        return wrong("the content does not have the texture's size");
    }
    return {};
}

Status checkDesc(const DeviceInfo& info, const ComputePipelineDesc& desc) {
    if (desc.shader == nullptr || !isStage(desc.shader, ShaderStage::Compute)) {
        return fail("pipeline '" + desc.name + "': no compute shader");
    }
    if (desc.wave != 0 && !info.waves.has(desc.wave)) {
        return fail("pipeline '" + desc.name + "': the device has no waves of " + std::to_string(desc.wave) +
                    " threads");
    }
    return {};
}

Status checkDesc(const DeviceInfo& info, const GraphicsPipelineDesc& desc) {
    const auto wrong = [&](const std::string& what) { return fail("pipeline '" + desc.name + "': " + what); };
    if (desc.vertex == nullptr) return wrong("no vertex shader");
    if (!isStage(desc.vertex, ShaderStage::Vertex) || !isStage(desc.hull, ShaderStage::Hull) ||
        !isStage(desc.domain, ShaderStage::Domain) || !isStage(desc.pixel, ShaderStage::Pixel)) {
        return wrong("a shader is given as another stage");
    }
    if ((desc.hull == nullptr) != (desc.domain == nullptr))
        return wrong("hull and domain shaders come together");
    const bool patches = desc.topology == Topology::PatchList;
    if (patches != (desc.hull != nullptr)) return wrong("a patch list and a hull shader come together");
    if (patches && !info.tessellation) return wrong("the device has no tessellation");
    if (patches && (desc.patchControlPoints < 1 || desc.patchControlPoints > 32)) {
        return wrong("1 to 32 control points a patch are possible");
    }
    if (desc.raster.fill == Fill::Wireframe && !info.wireframe)
        return wrong("the device has no wireframe mode");
    if (!desc.raster.depthClip && !info.depthClamp) return wrong("the device cannot clamp depth");
    if (desc.blend.size() != desc.colourFormats.size())
        return wrong("one blend state per colour target is needed");
    if (std::ranges::find(info.sampleCounts, desc.samples) == info.sampleCounts.end()) {
        return wrong("the device has no " + std::to_string(desc.samples) + " samples per pixel");
    }
    return {};
}

Result<DeviceInfo> chooseDevice(const std::vector<DeviceInfo>& infos, const DeviceOptions& options) {
    const DeviceInfo* best = nullptr;
    const DeviceInfo* refused = nullptr;
    for (const DeviceInfo& info : infos) {
        if (options.index && *options.index != info.index) continue;
        if (options.backend && *options.backend != info.backend) continue;
        if (lower(info.name).find(lower(options.name)) == std::string::npos) continue;
        if (!info.usable) {
            refused = &info;
        } else if (best == nullptr || rank(info.type) < rank(best->type)) {
            best = &info;
        }
    }
    if (best != nullptr) return *best;
    if (refused != nullptr)
        return fail("GPU '" + refused->name + "' cannot be used: " + refused->unusableReason,
                    "expected another GPU, as `devices` lists them");
    std::string names, asked;
    for (const DeviceInfo& info : infos)
        names += fmt::format("{}{}: {} ({})", names.empty() ? "" : ", ", info.index, info.name,
                             toString(info.backend));
    if (options.backend) asked += fmt::format(" with {}", toString(*options.backend));
    if (options.index) asked += fmt::format(" at index {}", *options.index);
    if (!options.name.empty()) asked += fmt::format(" named '{}'", options.name);
    return fail("no such GPU: there is none" + asked,
                names.empty() ? "expected a GPU and its driver" : "expected one of " + names);
}

tl::unexpected<Error> deviceLost(const DeviceInfo& info) {
    return fail("GPU '" + info.name + "' is lost", "a new device");
}

BufferDesc readBackDesc(std::uint64_t size) {
    BufferDesc desc;
    desc.name = "read back";
    desc.size = size;
    desc.usage = Usage::None;
    desc.memory = MemoryKind::ReadBack;
    return desc;
}

Status checkReadMapped(const BufferPtr& buffer, std::uint64_t offset, std::size_t size) {
    if (buffer == nullptr || buffer->desc().memory != MemoryKind::ReadBack) {
        return fail("reading a buffer that is not made for reading back");
    }
    if (offset > buffer->desc().size || size > buffer->desc().size - offset) {
        return fail("reading outside buffer '" + buffer->desc().name + "'");
    }
    return {};
}

Status checkReadTexture(const TexturePtr& texture, std::size_t size) {
    if (texture == nullptr) return fail("no texture to read");
    const TextureDesc& desc = texture->desc();
    if (size != std::uint64_t{desc.width} * desc.height * bytesPerTexel(desc.format)) {
        return fail("reading texture '" + desc.name + "' into memory of another size");
    }
    return {};
}

TextureDesc backBufferDesc(std::uint32_t width, std::uint32_t height) {
    TextureDesc desc;
    desc.name = "back buffer";
    desc.width = width;
    desc.height = height;
    desc.format = Format::Bgra8Unorm;
    desc.usage = Usage::RenderTarget | Usage::ShaderRead;
    return desc;
}

}  // namespace hairloom::gpu
