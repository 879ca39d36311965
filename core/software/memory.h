// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Buffers and textures in plain memory.

#include <cstring>

#include "core/gpu/device.h"

namespace hairloom::software {

class LazyShading;
class LazySky;

class HostBuffer : public gpu::Buffer {
  public:
    /// Errors: no memory for so many bytes.
    static Result<std::shared_ptr<HostBuffer>> make(const gpu::BufferDesc& desc,
                                                    std::span<const std::byte> content);

    std::span<std::byte> bytes() { return {bytes_.get(), static_cast<std::size_t>(desc().size)}; }
    std::span<const std::byte> bytes() const { return {bytes_.get(), static_cast<std::size_t>(desc().size)}; }

    // What is still to be written here, when somebody reads it.
    std::shared_ptr<LazyShading> shading;
    std::shared_ptr<LazySky> sky;

  private:
    explicit HostBuffer(const gpu::BufferDesc& desc) : gpu::Buffer(desc) {}
    std::unique_ptr<std::byte[]> bytes_;
};

/// Texels as floats, one or four each, with the values that their format can hold.
class HostTexture : public gpu::Texture {
  public:
    /// `content` as the format has it. Errors: no memory, a format or a number of samples that is not kept.
    static Result<std::shared_ptr<HostTexture>> make(const gpu::TextureDesc& desc,
                                                     std::span<const std::byte> content);

    std::uint32_t channels() const { return channels_; }
    std::span<float> texels() { return texels_; }
    std::span<const float> texels() const { return texels_; }
    /// Four channels of one pixel, rounded as the format does.
    void write(std::uint32_t x, std::uint32_t y, const float* rgba);
    /// Rows from the top, as the format has them.
    void copyTo(std::span<std::byte> target) const;

  private:
    explicit HostTexture(const gpu::TextureDesc& desc) : gpu::Texture(desc) {}
    std::uint32_t channels_ = 4;
    std::vector<float> texels_;
};

}  // namespace hairloom::software
