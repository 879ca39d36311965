// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/memory.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <new>

namespace hairloom::software {
namespace {

tl::unexpected<Error> noMemory(const std::string& name, std::uint64_t bytes) {
    return fail("no memory for '" + name + "', " + std::to_string(bytes) + " bytes",
                "a smaller image, or less hair");
}

bool hasBytes(gpu::Format format) {
    return format == gpu::Format::Rgba8Unorm || format == gpu::Format::Rgba8UnormSrgb ||
           format == gpu::Format::Bgra8Unorm;
}

/// IEC 61966-2-1.
float toSrgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float roundedTo8Bits(float value) {
    return std::floor(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f) / 255;
}

}  // namespace

Result<std::shared_ptr<HostBuffer>> HostBuffer::make(const gpu::BufferDesc& desc,
                                                     std::span<const std::byte> content) {
    std::shared_ptr<HostBuffer> buffer(new HostBuffer(desc));
    buffer->bytes_.reset(new (std::nothrow) std::byte[static_cast<std::size_t>(desc.size)]);
    if (buffer->bytes_ == nullptr) return noMemory(desc.name, desc.size);
    if (!content.empty()) std::memcpy(buffer->bytes_.get(), content.data(), content.size());
    return buffer;
}

Result<std::shared_ptr<HostTexture>> HostTexture::make(const gpu::TextureDesc& desc,
                                                       std::span<const std::byte> content) {
    const bool single = desc.format == gpu::Format::D32Float || desc.format == gpu::Format::R32Float;
    const bool half = desc.format == gpu::Format::Rgba16Float;
    const bool whole = desc.format == gpu::Format::Rgba32Float;
    if (!single && !half && !whole && !hasBytes(desc.format))
        return fail("texture '" + desc.name + "': the software renderer has no such format");
    if (desc.samples != 1)
        return fail("texture '" + desc.name + "': the software renderer keeps one sample a pixel");
    std::shared_ptr<HostTexture> texture(new HostTexture(desc));
    texture->channels_ = single ? 1 : 4;
    const std::uint64_t count = std::uint64_t{desc.width} * desc.height * texture->channels_;
    try {
        texture->texels_.resize(static_cast<std::size_t>(count));
    } catch (const std::bad_alloc&) {
        return noMemory(desc.name, count * sizeof(float));
    }
    if (content.empty()) return texture;
    for (std::size_t i = 0; i < texture->texels_.size(); ++i) {
        float& texel = texture->texels_[i];
        if (half) {
            std::uint16_t bits;
            std::memcpy(&bits, content.data() + i * sizeof(bits), sizeof(bits));
            texel = static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(bits));
        } else if (hasBytes(desc.format)) {
            texel = static_cast<float>(std::to_integer<std::uint8_t>(content[i])) / 255;
        } else {
            std::memcpy(&texel, content.data() + i * sizeof(float), sizeof(float));
        }
    }
    return texture;
}

void HostTexture::write(std::uint32_t x, std::uint32_t y, const float* rgba) {
    float* const texel = texels_.data() + (static_cast<std::size_t>(y) * desc().width + x) * channels_;
    const bool encodes = desc().format == gpu::Format::Rgba8UnormSrgb;
    for (std::uint32_t c = 0; c < channels_; ++c) {
        const float value = encodes && c < 3 ? toSrgb(std::clamp(rgba[c], 0.0f, 1.0f)) : rgba[c];
        texel[c] = hasBytes(desc().format) ? roundedTo8Bits(value) : value;
    }
}

void HostTexture::copyTo(std::span<std::byte> target) const {
    const bool swapped = desc().format == gpu::Format::Bgra8Unorm;
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        if (hasBytes(desc().format)) {
            const std::size_t channel = i % 4;
            const std::size_t source = swapped && channel != 3 ? i - channel + (2 - channel) : i;
            target[i] = static_cast<std::byte>(static_cast<std::uint8_t>(texels_[source] * 255 + 0.5f));
        } else if (desc().format == gpu::Format::Rgba16Float) {
            const auto bits = Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(texels_[i]));
            std::memcpy(target.data() + i * sizeof(bits), &bits, sizeof(bits));
        } else {
            std::memcpy(target.data() + i * sizeof(float), &texels_[i], sizeof(float));
        }
    }
}

}  // namespace hairloom::software
