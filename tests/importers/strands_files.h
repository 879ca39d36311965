// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strand files made byte by byte, independent of the writers.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "importers/strands.h"

namespace hairloom::strand_files {

using Bytes = std::vector<std::byte>;

inline Bytes bytesOf(const ByteWriter& writer) {
    return {writer.bytes().begin(), writer.bytes().end()};
}
inline Bytes bytesOf(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    return {bytes.begin(), bytes.end()};
}

inline Result<ImportedStrands> read(const Bytes& bytes, const StrandImportOptions& options = {}) {
    return importStrandsFromMemory("test", bytes, options);
}
inline Result<ImportedStrands> read(std::string_view text, const StrandImportOptions& options = {}) {
    return read(bytesOf(text), options);
}

/// Point i of strand s: a curl of ten centimetres on a head of twenty.
Vec3f curlPoint(std::size_t s, std::size_t i, std::size_t count);

/// Runs of `size` points on a head of twenty centimetres, in no order.
std::vector<Vec3f> runsOf(std::size_t strands, std::size_t size);

struct HairFile {
    std::uint32_t strands = 0;
    std::uint32_t points = 0;
    std::uint32_t arrays = 0;
    std::uint32_t defaultSegments = 0;
    float thickness = 1;
    float transparency = 0;
    std::array<float, 3> colour{1, 1, 1};
};

void writeHairHeader(ByteWriter& writer, const HairFile& file);

/// Strands of `points` points each, with every array the format has.
Bytes fullHair(std::uint32_t strands, std::uint32_t points);

/// TressFX 4 with every section, in the order positions, strand UVs, vertex UVs, thickness, colours.
Bytes fullTfx4(std::uint32_t strands, std::uint32_t points);

/// TressFX 3 with positions alone.
Bytes plainTfx3(std::uint32_t strands, std::uint32_t points);

enum class RibbonFaces { None, Quads, Triangles };

/// Cinema 4D hair: strands of `segments` segments as flat ribbons of `width`, left edge on curlPoint.
std::string ribbonObj(std::size_t strands, std::size_t segments, RibbonOrder order,
                      RibbonFaces faces = RibbonFaces::Quads, float width = 0.001f);

}  // namespace hairloom::strand_files
