// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/render/image.h"

namespace hairloom::render {

/// The bytes of a file; the same image gives the same. Errors: an image without pixels.
Result<std::vector<std::byte>> encodePng(const Image& image);

/// Writes the whole file or leaves what was there. The same image gives the same bytes.
Status writePng(const std::filesystem::path& path, const Image& image);

/// A PNG that plays its frames for ever, `milliseconds` each (1…65535); viewers that know nothing of that
/// show the first. Errors: no frames, or frames of different sizes.
Status writeAnimatedPng(const std::filesystem::path& path, std::span<const Image> frames,
                        std::uint32_t milliseconds);

/// Any PNG, as linear light, from the bytes of its file, which errors name. Errors: damaged, larger than
/// picture_limits.h allows. Of foreign files this is for the process that reads them
/// (importers/foreign_reader.h).
Result<LinearImage> decodePng(const std::string& file, std::span<const std::byte> bytes);

/// The same of a file of this program's own.
Result<LinearImage> readPng(const std::filesystem::path& path);

}  // namespace hairloom::render
