// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// Channels beside those of the picture: NAME.C for each letter C of `channels`.
struct ExrLayer {
    std::string name;
    std::string channels;
    std::vector<float> values;  ///< one a channel, pixel after pixel, rows from the top
};

/// OpenEXR: the channels R, G, B and A and those of the layers as 32-bit floats, ZIP compressed. Writes the
/// whole file or leaves what was there; the same content gives the same bytes.
Status writeExr(const std::filesystem::path& path, const LinearImage& image,
                std::span<const ExrLayer> layers = {});

/// OpenEXR of one part in lines of pixels: R, G, B, and A where it is there (else 1), or Y as grey. Half and
/// single floats, any compression that the library knows. Errors: not there, damaged, tiled, deep or of
/// several parts, more than 16384 pixels along a side, no such channels.
Result<LinearImage> readExr(const std::filesystem::path& path);

}  // namespace hairloom::render
