// SPDX-License-Identifier: GPL-3.0-or-later
// Yuksel's HAIR format, after its specification (cemyuksel.com/research/hairmodels).

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "core/base/file.h"
#include "importers/raw_strands.h"

namespace hairloom {
namespace {

struct Header {
    char signature[4];
    std::uint32_t strands;
    std::uint32_t points;
    std::uint32_t arrays;
    std::uint32_t defaultSegments;
    float defaultThickness;
    float defaultTransparency;
    float defaultColour[3];
    char info[88];
};
static_assert(sizeof(Header) == 128);

enum ArrayBits : std::uint32_t {
    kSegments = 1,
    kPoints = 2,
    kThickness = 4,
    kTransparency = 8,
    kColours = 16
};
constexpr std::uint32_t kKnownBits = 31;

template <class T>
Status readOptional(ByteReader& reader, bool present, std::uint64_t count, std::string_view what,
                    std::vector<T>& target) {
    if (!present) return {};
    auto values = reader.readArray<T>(count, what);
    if (!values) return tl::unexpected(values.error());
    target = std::move(*values);
    return {};
}

Status readVectors(ByteReader& reader, bool present, std::uint64_t count, std::string_view what,
                   std::vector<Vec3f>& target) {
    std::vector<std::array<float, 3>> triples;
    if (auto status = readOptional(reader, present, count, what, triples); !status) return status;
    target.reserve(triples.size());
    for (const auto& triple : triples) target.emplace_back(triple[0], triple[1], triple[2]);
    return {};
}

std::uint64_t bytesPerPoint(std::uint32_t arrays) {
    return 12u + ((arrays & kThickness) ? 4u : 0u) + ((arrays & kTransparency) ? 4u : 0u) +
           ((arrays & kColours) ? 12u : 0u);
}

/// Everything that can be told from the header and the file's size alone.
Status checkHeader(const Header& header, const ByteReader& reader, const std::string& file) {
    if (header.strands == 0) return failIn(file, Byte{4}, "holds 0 strands", "expected at least one");
    if (!(header.arrays & kPoints)) {
        return failIn(file, Byte{12}, fmt::format("array bits are {}: there are no points", header.arrays),
                      "expected bit 2 to be set");
    }
    const std::uint64_t segmentBytes = (header.arrays & kSegments) ? std::uint64_t{header.strands} * 2 : 0;
    const std::uint64_t needed =
        sizeof(Header) + segmentBytes + std::uint64_t{header.points} * bytesPerPoint(header.arrays);
    if (needed > reader.size()) {
        return failIn(
            file, Byte{4},
            fmt::format("{} strands with {} points need {} bytes", header.strands, header.points, needed),
            fmt::format("the file has {}", reader.size()));
    }
    if (!(header.arrays & kSegments) &&
        std::uint64_t{header.strands} * (std::uint64_t{header.defaultSegments} + 1) > header.points) {
        return failIn(
            file, Byte{16},
            fmt::format("{} strands of {} segments need {} points", header.strands, header.defaultSegments,
                        std::uint64_t{header.strands} * (std::uint64_t{header.defaultSegments} + 1)),
            fmt::format("the header says {}", header.points));
    }
    return {};
}

Status readOffsets(ByteReader& reader, const Header& header, const std::string& file, RawStrands& raw) {
    std::vector<std::uint16_t> segments;
    if (auto status = readOptional(reader, header.arrays & kSegments, header.strands, "segments", segments);
        !status) {
        return status;
    }
    raw.offsets.reserve(std::size_t{header.strands} + 1);
    std::uint64_t next = 0;
    for (std::uint32_t strand = 0; strand < header.strands; ++strand) {
        next +=
            (segments.empty() ? header.defaultSegments : std::uint32_t{segments[strand]}) + std::uint64_t{1};
        if (next > header.points) {
            return failIn(file, Byte{sizeof(Header) + std::uint64_t{strand} * 2},
                          fmt::format("the segments of strands 0 to {} need {} points", strand, next),
                          fmt::format("the header says {}", header.points));
        }
        raw.offsets.push_back(static_cast<std::uint32_t>(next));
    }
    return {};
}

void takeDefaults(const Header& header, RawStrands& raw) {
    // 1 and white are what the format's own library puts there when nobody says anything.
    if (header.defaultThickness != 1.0f) raw.defaultThickness = header.defaultThickness;
    const Vec3f colour(header.defaultColour[0], header.defaultColour[1], header.defaultColour[2]);
    const bool inRange = (colour.array() >= 0.0f).all() && (colour.array() <= 1.0f).all();
    if (inRange && colour != Vec3f::Ones()) raw.defaultColour = colour;
}

bool isHair(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "HAIR", 4) == 0;
}

Result<RawStrands> readHair(const std::string& file, std::vector<std::byte>&& bytes,
                            const StrandImportOptions&) {
    ByteReader reader(file, bytes);
    const auto header = reader.read<Header>("the header");
    if (!header) return tl::unexpected(header.error());
    if (auto status = checkHeader(*header, reader, file); !status) return tl::unexpected(status.error());

    RawStrands raw;
    raw.format = "Yuksel hair";
    if (auto status = readOffsets(reader, *header, file, raw); !status) return tl::unexpected(status.error());
    const std::uint32_t arrays = header->arrays;
    auto status = readVectors(reader, true, header->points, "points", raw.positions);
    if (status)
        status = readOptional(reader, arrays & kThickness, header->points, "thickness", raw.thickness);
    if (status)
        status =
            readOptional(reader, arrays & kTransparency, header->points, "transparency", raw.transparency);
    if (status) status = readVectors(reader, arrays & kColours, header->points, "colours", raw.colours);
    if (!status) return tl::unexpected(status.error());
    takeDefaults(*header, raw);

    if (raw.offsets.back() < header->points) {
        raw.warnings.push_back(
            Finding{Severity::Error,
                    fmt::format("{} points belong to no strand", header->points - raw.offsets.back()),
                    "header", "they were left out. Write the file again with matching counts"});
    }
    if (arrays & ~kKnownBits) {
        raw.warnings.push_back(fileWarning(fmt::format("array bits {:#x} are unknown", arrays & ~kKnownBits),
                                           "header", "their arrays were left out"));
    } else if (reader.remaining() > 0) {
        raw.warnings.push_back(
            Finding{Severity::Error, fmt::format("{} bytes follow the last array", reader.remaining()),
                    "end of file", "they were left out. Write the file again with matching counts"});
    }
    return raw;
}

}  // namespace

StrandReader hairReader() {
    return {{"Yuksel .hair", {"hair"}}, Recognition::Signature, isHair, readHair};
}

}  // namespace hairloom
