// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/render/image.h"
#include "importers/foreign_reader.h"

namespace hairloom {

/// A picture of one of the kinds, by the library of its format. Errors: as readPicture().
Result<render::LinearImage> decodePicture(const std::string& file, std::span<const std::byte> bytes,
                                          const std::vector<PictureKind>& kinds);

}  // namespace hairloom
