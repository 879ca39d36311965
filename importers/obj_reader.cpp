// SPDX-License-Identifier: GPL-3.0-or-later
// Strands of a Wavefront OBJ: lines where there are any, otherwise faces as Cinema 4D ribbons.

#include <algorithm>
#include <cstring>

#include "importers/raw_strands.h"

namespace hairloom {
namespace {

/// Text of any kind but PLY's. Anything but white space and comments may stand before the first vertex.
bool isText(std::span<const std::byte> bytes) {
    const auto start = bytes.first(std::min<std::size_t>(bytes.size(), 4096));
    if (start.size() >= 3 && std::memcmp(start.data(), "ply", 3) == 0) return false;
    return std::none_of(start.begin(), start.end(), [](std::byte b) { return b == std::byte{0}; });
}

Result<RawStrands> readObj(const std::string& file, std::vector<std::byte>&& bytes,
                           const StrandImportOptions& options) {
    const void* const characters = bytes.data();
    const auto obj = parseObjStrands(file, {static_cast<const char*>(characters), bytes.size()});
    if (!obj) return tl::unexpected(obj.error());
    std::vector<std::byte>().swap(bytes);
    if (obj->vertices.empty()) {
        return failIn(file, {}, "is text without a vertex",
                      "expected an OBJ file with lines or hair ribbons");
    }
    const bool hasLines = obj->lineOffsets.size() > 1;
    std::vector<std::uint32_t> vertices;
    auto raw = hasLines ? strandsFromLines(file, *obj, vertices) : strandsFromRibbons(file, *obj, options);
    if (!raw) return raw;
    raw->warnings.insert(raw->warnings.begin(), obj->warnings.begin(), obj->warnings.end());
    if (!hasLines && obj->faceLines.empty())
        raw->warnings.push_back(fileNote("points without lines and faces were taken for ribbons", "vertices",
                                         "if it is none of such, it may be cut short: write it again"));
    return raw;
}

}  // namespace

StrandReader objReader() {
    return {{"Wavefront OBJ", {"obj"}}, Recognition::Guess, isText, readObj};
}

}  // namespace hairloom
