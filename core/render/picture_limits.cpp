// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/picture_limits.h"

#include <fmt/format.h>

namespace hairloom::render {

Status checkPictureSize(const std::string& file, std::uint64_t width, std::uint64_t height,
                        std::uint64_t bytesPerPixel) {
    const std::string is = fmt::format("is {} × {} pixels", width, height);
    if (width == 0 || height == 0) return failIn(file, {}, is, "expected at least one");
    if (width > kMaxPictureSide || height > kMaxPictureSide || width * height > kMaxPicturePixels) {
        return failIn(file, {}, is,
                      fmt::format("expected at most {} in all and {} along a side; scale it down",
                                  kMaxPicturePixels, kMaxPictureSide));
    }
    if (const std::uint64_t bytes = width * height * bytesPerPixel; bytes > kMaxPictureBytes) {
        constexpr unsigned kToMebibytes = 20;
        return failIn(file, {},
                      fmt::format("{} of {} bytes each: {} MiB", is, bytesPerPixel, bytes >> kToMebibytes),
                      fmt::format("expected at most {} MiB; scale it down or leave channels out",
                                  kMaxPictureBytes >> kToMebibytes));
    }
    return {};
}

}  // namespace hairloom::render
