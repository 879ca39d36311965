// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/gpu/types.h"

namespace hairloom::render {

/// Size and quality of a picture; any of it may change from frame to frame.
struct RenderOptions {
    std::uint32_t width = 1280;  ///< pixels; width × height at most kMaxPixels
    std::uint32_t height = 720;
    std::uint32_t samples = 0;       ///< a pixel and frame: 1, 2, 4, 8; 0: the most the device has, up to 8
    std::uint32_t frames = 8;        ///< averaged, each moved by part of a pixel; 1…1024
    std::uint32_t subdivisions = 2;  ///< curve segments per segment of a strand, 1…64
    std::uint32_t shadowResolution = 1024;  ///< pixels of a light's square shadow map, 64…4096
    bool shadows = true;
    float exposure = 2;                  ///< factor before the tone curve
    bool transparentBackground = false;  ///< alpha is coverage; else 1 everywhere
};
inline constexpr std::uint64_t kMaxPixels = std::uint64_t{64} << 20u;

/// Errors: a size or number out of its range, for this device.
Status check(const RenderOptions& options, const gpu::DeviceInfo& device);

/// `samples` of the options, with 0 resolved. Errors: the device has no such number of samples.
Result<std::uint32_t> chooseSamples(const RenderOptions& options, const gpu::DeviceInfo& device);

}  // namespace hairloom::render
