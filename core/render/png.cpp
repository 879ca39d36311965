// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/png.h"

#include <png.h>

#include "core/base/file.h"

namespace hairloom::render {

Status writePng(const std::filesystem::path& path, const Image& image) {
    const std::size_t bytes = std::size_t{image.width} * image.height * 4;
    if (bytes == 0 || image.rgba.size() != bytes) return failIn(path.string(), {}, "an image without pixels");
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = image.width;
    png.height = image.height;
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::byte> file(PNG_IMAGE_PNG_SIZE_MAX(png));
    png_alloc_size_t size = file.size();
    if (png_image_write_to_memory(&png, file.data(), &size, 0, image.rgba.data(), 0, nullptr) == 0) {
        return failIn(path.string(), {}, std::string("cannot be encoded: ") + png.message);
    }
    return writeFileAtomically(path, std::span<const std::byte>(file.data(), size));
}

}  // namespace hairloom::render
