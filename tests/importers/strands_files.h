// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strand files made byte by byte, independent of the writers.

#include <fmt/format.h>

#include <array>
#include <cmath>
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
inline Vec3f curlPoint(std::size_t s, std::size_t i, std::size_t count) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    const float turn = 3.0f * t + static_cast<float>(s);
    return {0.03f * static_cast<float>(s % 7) + 0.01f * std::cos(turn), 1.6f - 0.1f * t,
            0.02f * static_cast<float>(s / 7) + 0.01f * std::sin(turn)};
}

struct HairFile {
    std::uint32_t strands = 0;
    std::uint32_t points = 0;
    std::uint32_t arrays = 0;
    std::uint32_t defaultSegments = 0;
    float thickness = 1;
    float transparency = 0;
    std::array<float, 3> colour{1, 1, 1};
};

inline void writeHairHeader(ByteWriter& writer, const HairFile& file) {
    writer.writeArray(std::span("HAIR", 4));
    writer.write(file);
    for (int i = 0; i < 88; ++i) writer.write(char{0});
}

/// Strands of `points` points each, with every array the format has.
inline Bytes fullHair(std::uint32_t strands, std::uint32_t points) {
    ByteWriter writer;
    writeHairHeader(writer, {strands, strands * points, 31, 0});
    for (std::uint32_t s = 0; s < strands; ++s) writer.write(static_cast<std::uint16_t>(points - 1));
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (std::uint32_t i = 0; i < points; ++i) {
            const Vec3f p = curlPoint(s, i, points);
            writer.writeArray(std::span<const float>(p.data(), 3));
        }
    }
    for (std::uint32_t i = 0; i < strands * points; ++i) writer.write(0.0001f * static_cast<float>(i + 1));
    for (std::uint32_t i = 0; i < strands * points; ++i) writer.write(0.01f * static_cast<float>(i % 100));
    for (std::uint32_t i = 0; i < strands * points * 3; ++i)
        writer.write(0.001f * static_cast<float>(i % 1000));
    return bytesOf(writer);
}

/// TressFX 4 with every section, in the order positions, strand UVs, vertex UVs, thickness, colours.
inline Bytes fullTfx4(std::uint32_t strands, std::uint32_t points) {
    const std::uint32_t total = strands * points;
    const std::uint32_t strandUvs = 160 + total * 16;
    const std::uint32_t pointUvs = strandUvs + strands * 8;
    const std::uint32_t thickness = pointUvs + total * 8;
    const std::uint32_t colours = thickness + strands * 4;
    ByteWriter writer;
    writer.write(4.0f);
    for (const std::uint32_t value : {strands, points, 160u, strandUvs, pointUvs, thickness, colours}) {
        writer.write(value);
    }
    for (int i = 0; i < 32; ++i) writer.write(0u);
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (std::uint32_t i = 0; i < points; ++i) {
            const Vec3f p = curlPoint(s, i, points);
            writer.writeArray(std::span<const float>(p.data(), 3));
            writer.write(i < 2 ? 0.0f : 1.0f);
        }
    }
    for (std::uint32_t i = 0; i < strands * 2; ++i) writer.write(0.01f * static_cast<float>(i));
    for (std::uint32_t i = 0; i < total * 2; ++i) writer.write(0.5f);
    for (std::uint32_t i = 0; i < strands; ++i) writer.write(0.1f * static_cast<float>(i));
    for (std::uint32_t i = 0; i < total * 4; ++i) writer.write(0.25f);
    return bytesOf(writer);
}

/// TressFX 3 with positions alone.
inline Bytes plainTfx3(std::uint32_t strands, std::uint32_t points) {
    ByteWriter writer;
    writer.write(3.0f);
    for (const std::uint32_t value : {strands, points, 0u, 0u}) writer.write(value);
    for (int i = 0; i < 31; ++i) writer.write(0u);
    writer.write(296u);
    for (int i = 0; i < 37; ++i) writer.write(0u);
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (std::uint32_t i = 0; i < points; ++i) {
            const Vec3f p = curlPoint(s, i, points);
            writer.writeArray(std::span<const float>(p.data(), 3));
        }
    }
    return bytesOf(writer);
}

enum class RibbonFaces { None, Quads, Triangles };

/// Cinema 4D hair: strands of `segments` segments as flat ribbons of `width`, left edge on curlPoint.
inline std::string ribbonObj(std::size_t strands, std::size_t segments, RibbonOrder order,
                             RibbonFaces faces = RibbonFaces::Quads, float width = 0.001f) {
    const std::size_t n = segments + 1;
    const auto left = [&](std::size_t i) { return order == RibbonOrder::Interleaved ? 2 * i : i; };
    const auto right = [&](std::size_t i) {
        if (order == RibbonOrder::Interleaved) return 2 * i + 1;
        return order == RibbonOrder::Around ? 2 * n - 1 - i : n + i;
    };
    std::string text = "# WF OBJ\ng Hair\n";
    for (std::size_t s = 0; s < strands; ++s) {
        std::vector<Vec3f> vertices(2 * n);
        for (std::size_t i = 0; i < n; ++i) {
            vertices[left(i)] = curlPoint(s, i, n);
            vertices[right(i)] = curlPoint(s, i, n) + Vec3f(0, 0, width);
        }
        for (const Vec3f& v : vertices) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", v.x(), v.y(), v.z());
    }
    if (faces == RibbonFaces::None) return text;
    for (std::size_t s = 0; s < strands; ++s) {
        const std::size_t base = s * 2 * n + 1;
        for (std::size_t i = 0; i < segments; ++i) {
            const std::size_t a = base + left(i);
            const std::size_t b = base + right(i);
            const std::size_t c = base + right(i + 1);
            const std::size_t d = base + left(i + 1);
            text += faces == RibbonFaces::Quads ? fmt::format("f {} {} {} {}\n", a, b, c, d)
                                                : fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d);
        }
    }
    return text;
}

}  // namespace hairloom::strand_files
