// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The machine's GPUs as DXGI lists them.

#include "core/gpu/d3d11/resources.h"

namespace hairloom::gpu::d3d11 {

/// Errors: DXGI cannot be started, or there is no GPU.
Result<std::vector<ComPtr<IDXGIAdapter1>>> listAdapters();

/// Opens the GPU at feature level 11_0. `debug`: with the debug layer, an error where it is not installed.
Status openDevice(IDXGIAdapter1* adapter, bool debug, Context& context);

/// What the GPU can do; it is opened for that.
DeviceInfo describe(IDXGIAdapter1* adapter, std::uint32_t index);

}  // namespace hairloom::gpu::d3d11
