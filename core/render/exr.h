// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/render/image.h"
#include "core/render/linear_space.h"

namespace hairloom::render {

/// Channels beside those of the picture: NAME.C for each letter C of `channels`.
struct ExrLayer {
    std::string name;
    std::string channels;
    std::vector<float> values;  ///< one a channel, pixel after pixel, rows from the top
};

/// OpenEXR: the channels R, G, B and A and those of the layers as 32-bit floats, ZIP compressed. The
/// attributes `chromaticities` and, where there is one, `colorInteropID` say what `space` is. Writes the
/// whole file or leaves what was there; the same content gives the same bytes.
Status writeExr(const std::filesystem::path& path, const LinearImage& image,
                std::span<const ExrLayer> layers = {}, const LinearSpace& space = {});

/// OpenEXR of one part in lines of pixels: R, G, B, and A where it is there (else 1), or Y as grey. Half and
/// single floats, any compression that the library knows. From the bytes of a file, which errors name.
/// Errors: damaged, tiled, deep or of several parts, larger than picture_limits.h allows, no such channels.
/// Of foreign files this is for the process that reads them (importers/foreign_reader.h).
Result<LinearImage> decodeExr(const std::string& file, std::span<const std::byte> bytes);

/// The same of a file of this program's own.
Result<LinearImage> readExr(const std::filesystem::path& path);

}  // namespace hairloom::render
