// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/checks.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom::gpu {

Status checkDesc(const DeviceInfo& info, const BufferDesc& desc, std::size_t content) {
    const auto wrong = [&](const std::string& what) { return fail("buffer '" + desc.name + "': " + what); };
    if (desc.size == 0) return wrong("a size of 0 bytes");
    if (desc.size > info.maxBufferBytes) {
        return wrong(fmt::format("{} bytes, the device allows {}", desc.size, info.maxBufferBytes));
    }
    if (content != 0 && content != desc.size) return wrong("the content does not have the buffer's size");
    if (content != 0 && desc.memory == MemoryKind::ReadBack)
        return wrong("a read-back buffer has no first content");
    return {};
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
        return wrong(fmt::format("the device has no {} samples a pixel", desc.samples));
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

}  // namespace hairloom::gpu
