// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/importers/strands_files.h"

#include <fmt/format.h>

#include <cmath>

namespace hairloom::strand_files {

Vec3f curlPoint(std::size_t s, std::size_t i, std::size_t count) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    const float turn = 3.0f * t + static_cast<float>(s);
    return {0.03f * static_cast<float>(s % 7) + 0.01f * std::cos(turn), 1.6f - 0.1f * t,
            0.02f * static_cast<float>(s / 7) + 0.01f * std::sin(turn)};
}

std::vector<Vec3f> runsOf(std::size_t strands, std::size_t size) {
    std::vector<Vec3f> points;
    for (std::size_t s = 0; s < strands; ++s) {
        const float turn = 2.4f * static_cast<float>(s);
        const Vec3f root(0.1f * std::cos(turn), 0.05f * std::sin(3 * turn), 0.1f * std::sin(turn));
        for (std::size_t i = 0; i < size; ++i) {
            const float along = 0.2f * static_cast<float>(i) / static_cast<float>(size - 1);
            points.emplace_back(root + Vec3f(0.01f * std::sin(40 * along), -along, 0));
        }
    }
    return points;
}

void writeHairHeader(ByteWriter& writer, const HairFile& file) {
    writer.writeArray(std::span("HAIR", 4));
    writer.write(file);
    for (int i = 0; i < 88; ++i) writer.write(char{0});
}

Bytes fullHair(std::uint32_t strands, std::uint32_t points) {
    ByteWriter writer;
    writer.reserve(4096);
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

Bytes fullTfx4(std::uint32_t strands, std::uint32_t points) {
    const std::uint32_t total = strands * points;
    const std::uint32_t strandUvs = 160 + total * 16;
    const std::uint32_t pointUvs = strandUvs + strands * 8;
    const std::uint32_t thickness = pointUvs + total * 8;
    const std::uint32_t colours = thickness + strands * 4;
    ByteWriter writer;
    writer.reserve(4096);
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

Bytes plainTfx3(std::uint32_t strands, std::uint32_t points) {
    ByteWriter writer;
    writer.reserve(4096);
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

std::string ribbonObj(std::size_t strands, std::size_t segments, RibbonOrder order, RibbonFaces faces,
                      float width) {
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
