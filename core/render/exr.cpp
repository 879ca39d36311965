// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/exr.h"

#include <tinyexr.h>

#include <array>
#include <cstring>
#include <memory>

#include "core/base/file.h"

namespace hairloom::render {
namespace {

// The library wants alphabetical order.
constexpr std::array<const char*, 4> kNames{"A", "B", "G", "R"};
constexpr std::array<std::size_t, 4> kPlaces{3, 2, 1, 0};

}  // namespace

Status writeExr(const std::filesystem::path& path, const LinearImage& image) {
    const std::size_t pixels = std::size_t{image.width} * image.height;
    if (pixels == 0 || image.rgba.size() != 4 * pixels)
        return failIn(path.string(), {}, "an image without pixels");
    std::array<std::vector<float>, 4> planes;
    std::array<unsigned char*, 4> pointers{};
    std::array<EXRChannelInfo, 4> channels{};
    std::array<int, 4> types{TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT,
                             TINYEXR_PIXELTYPE_FLOAT};
    for (std::size_t c = 0; c < 4; ++c) {
        planes[c].resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) planes[c][i] = image.rgba[4 * i + kPlaces[c]];
        pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
        std::strncpy(channels[c].name, kNames[c], sizeof(channels[c].name) - 1);
    }
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = 4;
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage content;
    InitEXRImage(&content);
    content.num_channels = 4;
    content.images = pointers.data();
    content.width = static_cast<int>(image.width);
    content.height = static_cast<int>(image.height);
    unsigned char* memory = nullptr;
    const char* error = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&content, &header, &memory, &error);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owned(memory, &std::free);
    if (size == 0) {
        const std::string why = error != nullptr ? error : "unknown reason";
        if (error != nullptr) FreeEXRErrorMessage(error);
        return failIn(path.string(), {}, "cannot be encoded: " + why);
    }
    return writeFileAtomically(path, std::as_bytes(std::span(memory, size)));
}

}  // namespace hairloom::render
