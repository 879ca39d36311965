// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Direct3D 11 and DXGI, and their words for ours. Feature level 11_0 is all that is asked for.

#include <windows.h>
// windows.h first.
#include <d3d11.h>
#include <dxgi1_3.h>
#include <wrl/client.h>

#include "core/gpu/device.h"

namespace hairloom::gpu::d3d11 {

using Microsoft::WRL::ComPtr;

/// "`what`: `reason` (0x887a0005)".
tl::unexpected<Error> failed(HRESULT result, const std::string& what);
/// After these nothing can be done with the device any more.
bool meansLost(HRESULT result);

DXGI_FORMAT toDxgi(Format format);

}  // namespace hairloom::gpu::d3d11
