// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The backend's way in, free of Vulkan's headers.

#include "core/gpu/device.h"

namespace hairloom::gpu::vulkan {

Result<std::vector<DeviceInfo>> listDevices();
/// `index`: place in the backend's own list; `info`: what stands there.
Result<std::unique_ptr<Device>> openDevice(std::uint32_t index, const DeviceInfo& info,
                                           const DeviceOptions& options);

}  // namespace hairloom::gpu::vulkan
