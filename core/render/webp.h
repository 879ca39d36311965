// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// A WebP that plays its frames for ever, `milliseconds` each (1…65535), lossy at quality 90: a tenth of the
/// bytes of an animated PNG. Errors: no frames, frames of different sizes or above 16383 pixels along a side,
/// a program built without libwebp.
Status writeAnimatedWebp(const std::filesystem::path& path, std::span<const Image> frames,
                         std::uint32_t milliseconds);

}  // namespace hairloom::render
