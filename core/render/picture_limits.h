// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How large pictures that are read may be: a file of a few kilobytes can say any size.

#include <cstdint>
#include <string>

#include "core/base/result.h"

namespace hairloom::render {

/// 8192 × 8192 or 16384 × 4096.
inline constexpr std::uint64_t kMaxPicturePixels = std::uint64_t{1} << 26u;
inline constexpr std::uint32_t kMaxPictureSide = 32768;
/// While it is decoded, beside the file itself.
inline constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{3} << 30u;

/// Errors: no pixels, more than these limits; `bytesPerPixel` are those of all that decoding holds at once.
Status checkPictureSize(const std::string& file, std::uint64_t width, std::uint64_t height,
                        std::uint64_t bytesPerPixel);

}  // namespace hairloom::render
