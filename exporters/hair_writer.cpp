// SPDX-License-Identifier: GPL-3.0-or-later
// Yuksel's HAIR format. The segments array is always written: some readers expect it.

#include <fmt/format.h>

#include <algorithm>

#include "exporters/prepared_strands.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kMaxSegments = 65535;
constexpr std::uint32_t kAdvisablePoints = 32;  ///< Jolt Physics

Result<std::vector<std::uint16_t>> segmentCounts(const PreparedStrands& strands) {
    std::vector<std::uint16_t> segments(strands.strandCount());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const std::uint32_t count = strands.offsets[i + 1] - strands.offsets[i] - 1;
        if (count > kMaxSegments) {
            return fail(fmt::format("strand {} has {} segments", strands.sources[i], count),
                        fmt::format("a .hair strand has at most {}: resample it", kMaxSegments));
        }
        segments[i] = static_cast<std::uint16_t>(count);
    }
    return segments;
}

void writeHeader(ByteWriter& writer, const Groom& groom, const PreparedStrands& strands,
                 const StrandExportOptions& options) {
    std::uint32_t arrays = 1 | 2 | 4;
    if (!strands.transparency.empty()) arrays |= 8;
    if (!strands.colours.empty()) arrays |= 16;
    writer.writeArray(std::span("HAIR", 4));
    writer.write(static_cast<std::uint32_t>(strands.strandCount()));
    writer.write(static_cast<std::uint32_t>(strands.positions.size()));
    writer.write(arrays);
    writer.write(strands.offsets[1] - strands.offsets[0] - 1);
    writer.write(2.0f * groom.material.rootRadius / options.metresPerUnit);
    writer.write(0.0f);
    for (int channel = 0; channel < 3; ++channel) writer.write(groom.material.rootColour[channel]);
    std::string info = fmt::format("Hairloom; 1 unit = {} m; {} up; thickness is a diameter",
                                   options.metresPerUnit, options.up == UpAxis::Y ? "Y" : "Z");
    info.resize(88, '\0');
    writer.writeArray(std::span<const char>(info));
}

void writeVectors(ByteWriter& writer, std::span<const Vec3f> values) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    if (!values.empty()) writer.writeArray(std::span<const float>(values[0].data(), values.size() * 3));
}

void addLimits(PreparedStrands& strands) {
    std::uint32_t maximum = 0;
    for (std::size_t i = 0; i < strands.strandCount(); ++i) {
        maximum = std::max(maximum, strands.offsets[i + 1] - strands.offsets[i]);
    }
    if (maximum > kAdvisablePoints) {
        strands.findings.push_back({Severity::Info, fmt::format("strands have up to {} points", maximum),
                                    "points", "for Jolt Physics, resample to 32 or fewer"});
    }
}

Result<ExportReport> writeHair(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    const auto segments = segmentCounts(*strands);
    if (!segments) return tl::unexpected(inFile(segments.error(), path.string()));
    addLimits(*strands);

    ByteWriter writer;
    writer.reserve(128 + segments->size() * 2 + strands->positions.size() * 32);
    writeHeader(writer, groom, *strands, options);
    writer.writeArray(std::span<const std::uint16_t>(*segments));
    writeVectors(writer, strands->positions);
    writer.writeArray(std::span<const float>(strands->thickness));
    writer.writeArray(std::span<const float>(strands->transparency));
    writeVectors(writer, strands->colours);
    return writeAndCompare(groom, std::move(*strands), options, path, std::move(writer).take());
}

}  // namespace

HairWriter hairWriter() {
    StrandExportOptions jolt, unity;
    jolt.pointsPerStrand = 32;
    jolt.limits = {"Jolt Physics", 0, 32, 2, false};
    unity.limits = unityLimits();
    return {"hair",
            "Yuksel .hair",
            "width, transparency and colour of each point",
            "at most 65,535 segments per strand",
            {{"plain", "Yuksel .hair", ".hair in metres, Y up. Strands keep their points", {}},
             {"jolt", "Jolt Physics", ".hair in metres, Y up, with 32 points per strand, as Jolt recommends",
              jolt},
             {"unity", "Unity hair", ".hair in metres, Y up, with 3 to 128 points and at most 64,000 strands",
              unity}},
            writeHair};
}

}  // namespace hairloom
