// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/picture_file.h"

#include <algorithm>

#include "core/render/exr.h"
#include "core/render/png.h"
#include "importers/mesh_reader/jpeg.h"
#include "importers/picture_stream.h"

namespace hairloom {
namespace {

std::string namesOf(const std::vector<PictureKind>& kinds) {
    std::string names;
    for (std::size_t i = 0; i < kinds.size(); ++i)
        names.append(i == 0 ? "" : i + 1 < kinds.size() ? ", " : " or ").append(name(kinds[i]));
    return names;
}

}  // namespace

Result<render::LinearImage> decodePicture(const std::string& file, std::span<const std::byte> bytes,
                                          const std::vector<PictureKind>& kinds) {
    const auto kind = pictureKindOf(bytes);
    if (!kind || std::ranges::find(kinds, *kind) == kinds.end()) {
        const std::string found = bytes.empty() ? "is empty"
                                  : kind        ? "is an image in the format " + std::string(name(*kind))
                                                : "is not in a supported image format";
        return failIn(file, {}, found, "expected an image in the format " + namesOf(kinds));
    }
    switch (*kind) {
        case PictureKind::Png:
            return render::decodePng(file, bytes);
        case PictureKind::Exr:
            return render::decodeExr(file, bytes);
        case PictureKind::Jpeg:
            break;
    }
    return decodeJpeg(file, bytes);
}

}  // namespace hairloom
