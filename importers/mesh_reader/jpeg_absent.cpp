// SPDX-License-Identifier: GPL-3.0-or-later
// For platforms without libjpeg.
#include "importers/mesh_reader/jpeg.h"

namespace hairloom {

Result<render::LinearImage> decodeJpeg(const std::string& file, std::span<const std::byte>) {
    return failIn(file, {}, "is a JPEG, which this build does not read", "expected a PNG");
}

}  // namespace hairloom
