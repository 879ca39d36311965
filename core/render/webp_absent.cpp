// SPDX-License-Identifier: GPL-3.0-or-later
// For programs that are built without libwebp.
#include "core/render/webp.h"

namespace hairloom::render {

Status writeAnimatedWebp(const std::filesystem::path& path, std::span<const Image>, std::uint32_t) {
    return failIn(path.string(), {}, "this program was built without libwebp and cannot write WebP",
                  "expected a name that ends in .png");
}

}  // namespace hairloom::render
