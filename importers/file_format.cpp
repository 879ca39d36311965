// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/file_format.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace hairloom {
namespace {

bool beginsWith(std::span<const std::byte> bytes, std::string_view start) {
    return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

/// A zip whose first file's name is that of a layer.
bool isPackage(std::span<const std::byte> bytes) {
    constexpr std::size_t kNameSize = 26, kName = 30;
    if (!beginsWith(bytes, "PK\x03\x04") || bytes.size() < kName) return false;
    const std::size_t size = std::to_integer<std::size_t>(bytes[kNameSize]) |
                             std::to_integer<std::size_t>(bytes[kNameSize + 1]) << 8u;
    const std::string_view name(reinterpret_cast<const char*>(bytes.data()) + kName,
                                std::min(size, bytes.size() - kName));
    return name.ends_with(".usd") || name.ends_with(".usda") || name.ends_with(".usdc");
}

}  // namespace

bool startsLikeUsd(std::span<const std::byte> head) {
    return beginsWith(head, "#usda") || beginsWith(head, "PXR-USDC") || isPackage(head);
}

bool startsLikeAlembic(std::span<const std::byte> head) {
    return beginsWith(head, "Ogawa") || beginsWith(head, "\x89HDF\r\n\x1a\n");
}

std::string labelsOf(std::span<const FileFormat> formats) {
    std::string text;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        if (i > 0) text += i + 1 < formats.size() ? ", " : " or ";
        text += formats[i].label;
    }
    return text;
}

}  // namespace hairloom
