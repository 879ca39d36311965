// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/d3d11/api.h"

#include <fmt/format.h>

namespace hairloom::gpu::d3d11 {
namespace {

const char* reason(HRESULT result) {
    switch (result) {
        case E_OUTOFMEMORY:
            return "out of memory";
        case E_INVALIDARG:
            return "the driver refuses these arguments";
        case DXGI_ERROR_DEVICE_REMOVED:
            return "the device was removed";
        case DXGI_ERROR_DEVICE_RESET:
            return "the device was reset";
        case DXGI_ERROR_DEVICE_HUNG:
            return "the device hangs";
        case DXGI_ERROR_DRIVER_INTERNAL_ERROR:
            return "an error inside the driver";
        case DXGI_ERROR_UNSUPPORTED:
            return "not supported";
        case DXGI_ERROR_SDK_COMPONENT_MISSING:
            return "the debug layer is not installed";
        default:
            return "Direct3D failed";
    }
}

}  // namespace

tl::unexpected<Error> failed(HRESULT result, const std::string& what) {
    return fail(fmt::format("{}: {} (0x{:08x})", what, reason(result), static_cast<std::uint32_t>(result)),
                "expected what the device can do: try another device, less hair, or the CPU");
}

bool meansLost(HRESULT result) {
    return result == DXGI_ERROR_DEVICE_REMOVED || result == DXGI_ERROR_DEVICE_RESET ||
           result == DXGI_ERROR_DEVICE_HUNG || result == DXGI_ERROR_DRIVER_INTERNAL_ERROR;
}

DXGI_FORMAT toDxgi(Format format) {
    switch (format) {
        case Format::Unknown:
            return DXGI_FORMAT_UNKNOWN;
        case Format::R8Unorm:
            return DXGI_FORMAT_R8_UNORM;
        case Format::Rgba8Unorm:
            return DXGI_FORMAT_R8G8B8A8_UNORM;
        case Format::Rgba8UnormSrgb:
            return DXGI_FORMAT_R8G8B8A8_UNORM_SRGB;
        case Format::Bgra8Unorm:
            return DXGI_FORMAT_B8G8R8A8_UNORM;
        case Format::Rgba16Unorm:
            return DXGI_FORMAT_R16G16B16A16_UNORM;
        case Format::Rgba16Float:
            return DXGI_FORMAT_R16G16B16A16_FLOAT;
        case Format::R32Uint:
            return DXGI_FORMAT_R32_UINT;
        case Format::R32Float:
            return DXGI_FORMAT_R32_FLOAT;
        case Format::Rg32Float:
            return DXGI_FORMAT_R32G32_FLOAT;
        case Format::Rgb32Float:
            return DXGI_FORMAT_R32G32B32_FLOAT;
        case Format::Rgba32Float:
            return DXGI_FORMAT_R32G32B32A32_FLOAT;
        case Format::D32Float:
            return DXGI_FORMAT_D32_FLOAT;
    }
    return DXGI_FORMAT_UNKNOWN;
}

}  // namespace hairloom::gpu::d3d11
