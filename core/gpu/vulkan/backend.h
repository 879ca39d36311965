// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The backend's way in, free of Vulkan's headers.

#include "core/gpu/device.h"

namespace hairloom::gpu::vulkan {

Result<std::vector<DeviceInfo>> listDevices();
Result<std::unique_ptr<Device>> createDevice(const DeviceOptions& options);

}  // namespace hairloom::gpu::vulkan
