// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The backend's way in, free of Direct3D's headers.

#include "core/gpu/device.h"

namespace hairloom::gpu::d3d11 {

Result<std::vector<DeviceInfo>> listDevices();
/// `index`: place in the backend's own list; `info`: what stands there.
Result<std::unique_ptr<Device>> openDevice(std::uint32_t index, const DeviceInfo& info,
                                           const DeviceOptions& options);

}  // namespace hairloom::gpu::d3d11
