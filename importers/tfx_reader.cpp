// SPDX-License-Identifier: GPL-3.0-or-later
// TressFX asset files: version 4 (160-byte header, float4 positions) and version 3 (296-byte header, float3
// positions), after the headers of AMD's TressFX 4.1 and 3.1.1.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/base/file.h"
#include "importers/raw_strands.h"
#include "importers/tfx_bones.h"

namespace hairloom {
namespace {

struct HeaderV4 {
    static constexpr std::string_view kFormat = "TressFX 4";
    static constexpr std::uint64_t kBytesPerPoint = 16;
    static constexpr bool kLeftHanded = false;
    float version;
    std::uint32_t strands;
    std::uint32_t pointsPerStrand;
    std::uint32_t positionOffset;
    std::uint32_t strandUvOffset;
    std::uint32_t pointUvOffset;
    std::uint32_t thicknessOffset;
    std::uint32_t colourOffset;
    std::uint32_t reserved[32];
};
static_assert(sizeof(HeaderV4) == 160);

struct HeaderV3 {
    static constexpr std::string_view kFormat = "TressFX 3";
    static constexpr std::uint64_t kBytesPerPoint = 12;
    static constexpr bool kLeftHanded = true;
    float version;
    std::uint32_t strands;
    std::uint32_t pointsPerStrand;
    std::uint32_t followPerGuide;
    std::uint32_t bothEndsImmovable;
    std::uint32_t reserved1[31];
    std::uint32_t positionOffset;
    std::uint32_t thicknessOffset;
    std::uint32_t strandUvOffset;
    std::uint32_t colourOffset;
    std::uint32_t guideOffset;
    std::uint32_t pointUvOffset;
    std::uint32_t reserved2[32];
};
static_assert(sizeof(HeaderV3) == 296);

/// An array of the file. Offset 0 says that it is absent.
struct Section {
    std::string_view name;
    std::uint64_t offset;
    std::uint64_t bytes;
    std::uint64_t headerField;  ///< byte of the header that holds the offset
};

/// The two versions, told alike.
struct Layout {
    std::uint64_t headerBytes;
    std::uint64_t strands;
    std::uint64_t pointsPerStrand;
    Section positions, strandUvs, pointUvs, thickness, colours;
    std::uint64_t bytesPerPoint;
};

template <class Header>
Layout layoutOf(const Header& header) {
    const std::uint64_t strands = header.strands;
    const std::uint64_t points = strands * header.pointsPerStrand;
    return {sizeof(Header),
            strands,
            header.pointsPerStrand,
            {"positions", header.positionOffset, points * Header::kBytesPerPoint,
             offsetof(Header, positionOffset)},
            {"strand UVs", header.strandUvOffset, strands * 8, offsetof(Header, strandUvOffset)},
            {"vertex UVs", header.pointUvOffset, points * 8, offsetof(Header, pointUvOffset)},
            {"strand thickness", header.thicknessOffset, strands * 4, offsetof(Header, thicknessOffset)},
            {"vertex colours", header.colourOffset, points * 16, offsetof(Header, colourOffset)},
            Header::kBytesPerPoint};
}

Status checkSection(const Section& section, const Layout& layout, std::uint64_t size,
                    const std::string& file) {
    if (section.offset < layout.headerBytes || section.offset % 4 != 0) {
        return failIn(
            file, Byte{section.headerField},
            fmt::format("{} would start at byte {}", section.name, section.offset),
            fmt::format("expected a multiple of 4 after the header of {} bytes", layout.headerBytes));
    }
    if (section.offset > size || section.bytes > size - section.offset) {
        return failIn(
            file, Byte{section.headerField},
            fmt::format("{} need {} bytes from byte {} on", section.name, section.bytes, section.offset),
            fmt::format("the file has {}", size));
    }
    return {};
}

Status checkOverlaps(std::vector<Section> sections, const std::string& file) {
    std::sort(sections.begin(), sections.end(),
              [](const Section& a, const Section& b) { return a.offset < b.offset; });
    for (std::size_t i = 1; i < sections.size(); ++i) {
        const Section& before = sections[i - 1];
        if (before.offset + before.bytes <= sections[i].offset) continue;
        return failIn(file, Byte{sections[i].headerField},
                      fmt::format("{} start at byte {}, inside the {}", sections[i].name, sections[i].offset,
                                  before.name),
                      fmt::format("expected byte {} or later", before.offset + before.bytes));
    }
    return {};
}

Status checkLayout(const Layout& layout, std::uint64_t size, const std::string& file) {
    if (layout.strands == 0) return failIn(file, Byte{4}, "holds 0 strands", "expected at least one");
    if (layout.pointsPerStrand == 0)
        return failIn(file, Byte{8}, "strands have 0 vertices", "expected at least two");
    if (layout.strands * layout.pointsPerStrand > size / layout.bytesPerPoint) {
        return failIn(
            file, Byte{4},
            fmt::format("{} strands of {} vertices do not fit", layout.strands, layout.pointsPerStrand),
            fmt::format("the file has {} bytes", size));
    }
    std::vector<Section> present;
    for (const Section& section :
         {layout.positions, layout.strandUvs, layout.pointUvs, layout.thickness, layout.colours}) {
        if (section.offset == 0 && section.name != layout.positions.name) continue;
        if (auto status = checkSection(section, layout, size, file); !status) return status;
        present.push_back(section);
    }
    return checkOverlaps(std::move(present), file);
}

/// Bytes that no section has, which are the rest of what the file holds when a count in its header is too
/// small. Writers align sections: a few bytes are none.
std::vector<Finding> findGaps(const Layout& layout, std::uint64_t size) {
    constexpr std::uint64_t kAlignment = 16;
    std::vector<Section> present;
    for (const Section& section :
         {layout.positions, layout.strandUvs, layout.pointUvs, layout.thickness, layout.colours}) {
        if (section.offset != 0) present.push_back(section);
    }
    std::ranges::sort(present, {}, &Section::offset);
    std::vector<Finding> gaps;
    for (std::size_t i = 0; i < present.size(); ++i) {
        const std::uint64_t end = present[i].offset + present[i].bytes;
        const std::uint64_t next = i + 1 < present.size() ? present[i + 1].offset : size;
        if (next - end < kAlignment) continue;
        gaps.push_back(
            {Severity::Error,
             fmt::format("{} bytes after the {} are not used: the header has {} strands of {} vertices",
                         next - end, present[i].name, layout.strands, layout.pointsPerStrand),
             fmt::format("byte {}", end), "correct the counts in the header, or write the file again"});
    }
    return gaps;
}

/// The section's bytes; its place was checked.
std::span<const std::byte> sectionBytes(std::span<const std::byte> bytes, const Section& section) {
    return bytes.subspan(static_cast<std::size_t>(section.offset), static_cast<std::size_t>(section.bytes));
}

std::vector<float> copyFloats(std::span<const std::byte> bytes, const Section& section) {
    std::vector<float> values;
    if (section.offset == 0) return values;
    const auto source = sectionBytes(bytes, section);
    values.resize(source.size() / sizeof(float));
    std::memcpy(values.data(), source.data(), values.size() * sizeof(float));
    return values;
}

/// The first components of each element of `stride` bytes.
template <class Vector>
std::vector<Vector> copyVectors(std::span<const std::byte> bytes, const Section& section,
                                std::size_t stride) {
    std::vector<Vector> values;
    if (section.offset == 0) return values;
    const auto source = sectionBytes(bytes, section);
    values.resize(source.size() / stride);
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::memcpy(values[i].data(), source.data() + i * stride, sizeof(Vector));
    }
    return values;
}

bool bothEndsImmovable(const HeaderV3& header, const Layout&, std::span<const std::byte>) {
    return header.bothEndsImmovable != 0;
}

/// Version 4 marks immovable points by an inverse mass of 0 beside their position.
bool bothEndsImmovable(const HeaderV4&, const Layout& layout, std::span<const std::byte> bytes) {
    if (layout.pointsPerStrand <= 2) return false;
    const auto positions = sectionBytes(bytes, layout.positions);
    const std::size_t strandBytes = static_cast<std::size_t>(layout.pointsPerStrand) * 16;
    for (std::size_t end = strandBytes; end <= positions.size(); end += strandBytes) {
        float inverseMass = 0;
        std::memcpy(&inverseMass, positions.data() + end - 4, sizeof inverseMass);
        if (inverseMass != 0.0f) return false;
    }
    return true;
}

RawStrands readSections(std::span<const std::byte> bytes, const Layout& layout) {
    RawStrands raw;
    raw.positions =
        copyVectors<Vec3f>(bytes, layout.positions, static_cast<std::size_t>(layout.bytesPerPoint));
    raw.rootUvs = copyVectors<Vec2f>(bytes, layout.strandUvs, 8);
    raw.thicknessScale = copyFloats(bytes, layout.thickness);
    raw.colours = copyVectors<Vec3f>(bytes, layout.colours, 16);
    raw.offsets.resize(static_cast<std::size_t>(layout.strands) + 1);
    for (std::size_t strand = 0; strand < raw.offsets.size(); ++strand) {
        raw.offsets[strand] = static_cast<std::uint32_t>(strand * layout.pointsPerStrand);
    }
    if (layout.pointUvs.offset != 0) {
        raw.warnings.push_back(fileNote("texture coordinates per vertex were left out", "vertex UVs"));
    }
    return raw;
}

template <class Header>
Result<RawStrands> readVersion(const std::string& file, std::span<const std::byte> bytes) {
    ByteReader reader(file, bytes);
    const auto header = reader.read<Header>("the header");
    if (!header) return tl::unexpected(header.error());
    const Layout layout = layoutOf(*header);
    if (auto status = checkLayout(layout, bytes.size(), file); !status) return tl::unexpected(status.error());
    RawStrands raw = readSections(bytes, layout);
    raw.format = Header::kFormat;
    raw.mirrorZ = Header::kLeftHanded;
    // Version 3 has further sections, which are not known here.
    if (!raw.mirrorZ) {
        for (Finding& gap : findGaps(layout, bytes.size())) raw.warnings.push_back(std::move(gap));
    }
    if (raw.mirrorZ)
        raw.warnings.push_back(fileNote("version 3 is left-handed, so Z was negated", "positions"));
    if (bothEndsImmovable(*header, layout, bytes)) {
        raw.warnings.push_back(
            fileNote("both ends of the strands are marked immovable, but Hairloom fixes only the root",
                     "strand tips", "constrain the tips again where you need that"));
    }
    return raw;
}

/// The version is a small whole number, whose last byte in memory, the first of the file, is 0.
bool isTfx(std::span<const std::byte> bytes) {
    float version = 0;
    if (bytes.size() < sizeof version) return false;
    std::memcpy(&version, bytes.data(), sizeof version);
    return version >= 1.0f && version < 8.0f && std::to_integer<int>(bytes[0]) == 0;
}

Result<RawStrands> readTfx(const std::string& file, std::vector<std::byte>&& bytes,
                           const StrandImportOptions&) {
    ByteReader reader(file, bytes);
    const auto version = reader.read<float>("the version");
    if (!version) return tl::unexpected(version.error());
    if (*version >= 4.0f && *version < 5.0f) return readVersion<HeaderV4>(file, bytes);
    if (*version >= 3.0f && *version < 4.0f) return readVersion<HeaderV3>(file, bytes);
    return failIn(file, Byte{0}, fmt::format("is TressFX version {}", *version), "expected version 3 or 4");
}

}  // namespace

StrandReader tfxReader() {
    return {{"TressFX .tfx (version 3 or 4)", {"tfx"}},
            Recognition::Signature,
            isTfx,
            readTfx,
            "tfxbone",
            readTfxBones};
}

}  // namespace hairloom
