// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What descriptions and calls must fulfil, and what is chosen, on any backend.

#include "core/base/result.h"
#include "core/gpu/device.h"

namespace hairloom::gpu {

/// `content`: bytes of first content, 0 for none. Errors name the resource, and the limit where there is one.
Status checkDesc(const DeviceInfo& info, const BufferDesc& desc, std::size_t content);
Status checkDesc(const DeviceInfo& info, const TextureDesc& desc, std::size_t content);
Status checkDesc(const DeviceInfo& info, const GraphicsPipelineDesc& desc);
Status checkDesc(const DeviceInfo& info, const ComputePipelineDesc& desc);

/// The usable device that fits the options; a GPU before a software rasteriser, then list order. Errors: none
/// fits, or what the one that fits lacks.
Result<DeviceInfo> chooseDevice(const std::vector<DeviceInfo>& infos, const DeviceOptions& options);

tl::unexpected<Error> deviceLost(const DeviceInfo& info);

/// A buffer that Device::readBuffer() and readTexture() copy to, and what reading may go wrong with.
BufferDesc readBackDesc(std::uint64_t size);
Status checkReadMapped(const BufferPtr& buffer, std::uint64_t offset, std::size_t size);
Status checkReadTexture(const TexturePtr& texture, std::size_t size);

/// What SwapChain::backBuffer() is.
TextureDesc backBufferDesc(std::uint32_t width, std::uint32_t height);

}  // namespace hairloom::gpu
