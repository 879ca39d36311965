// SPDX-License-Identifier: GPL-3.0-or-later
// TressFX 4 asset files. AMD's loaders seek to the UVs without asking whether there are any, so there always
// are.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/content_kind.h"
#include "core/base/output_file.h"
#include "exporters/prepared_strands.h"
#include "exporters/tfx_companions.h"

namespace hairloom {
namespace {

constexpr std::size_t kHeaderBytes = 160;
/// Points that TressFX can have on a strand.
constexpr std::array<std::uint32_t, 5> kTfxPointCounts{4, 8, 16, 32, 64};
/// A compute dispatch has at most 65,535 groups in each direction, and TressFX's have 64 threads, one per
/// vertex.
constexpr std::size_t kMaxVertices = std::size_t{65535} * 64;

bool isAllowed(std::size_t points) {
    return std::find(kTfxPointCounts.begin(), kTfxPointCounts.end(), points) != kTfxPointCounts.end();
}

/// The allowed count nearest, by ratio, to the median strand's.
std::uint32_t nearestAllowed(const Groom& groom) {
    std::vector<std::uint32_t> counts(groom.strandCount());
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = groom.offsets[i + 1] - groom.offsets[i];
    const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
    std::nth_element(counts.begin(), middle, counts.end());
    const double wanted = std::log(std::max(1.0, static_cast<double>(*middle)));
    return *std::min_element(kTfxPointCounts.rbegin(), kTfxPointCounts.rend(),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return std::abs(std::log(static_cast<double>(a)) - wanted) <
                                        std::abs(std::log(static_cast<double>(b)) - wanted);
                             });
}

Result<std::uint32_t> choosePoints(const Groom& groom, const StrandExportOptions& options) {
    if (groom.strandCount() == 0) return fail("the groom has no strand", "expected at least one to write");
    if (options.pointsPerStrand == 0) return nearestAllowed(groom);
    if (isAllowed(options.pointsPerStrand)) return options.pointsPerStrand;
    return fail(fmt::format("{} vertices per strand", options.pointsPerStrand),
                "TressFX can have 4, 8, 16, 32 or 64");
}

/// Loaders read root UVs wherever the header says that they are: there are always some.
std::vector<Vec2f> rootUvsOrZeros(const Groom& groom, PreparedStrands& strands) {
    std::vector<Vec2f> uvs = rootUvs(groom, strands);
    if (!uvs.empty()) return uvs;
    strands.findings.push_back({Severity::Warning, "root UVs are missing, so all are (0, 0)", "root UVs",
                                "bind the strands to a scalp with UVs to colour them by its texture"});
    uvs.resize(strands.strandCount(), Vec2f::Zero());
    return uvs;
}

struct TfxSections {
    std::vector<Vec2f> uvs;
    std::vector<float> thicknessScale;  ///< per strand, or empty
};

/// In the order of the file: header, positions, strand UVs, strand thickness, vertex colours.
void writeHeader(ByteWriter& writer, const PreparedStrands& strands, const TfxSections& sections,
                 std::uint32_t points) {
    const std::size_t uvOffset = kHeaderBytes + strands.positions.size() * 16;
    const std::size_t thicknessOffset = uvOffset + sections.uvs.size() * 8;
    const std::size_t colourOffset = (thicknessOffset + sections.thicknessScale.size() * 4 + 7) / 8 * 8;
    writer.write(4.0f);
    writer.write(static_cast<std::uint32_t>(strands.strandCount()));
    writer.write(points);
    writer.write(static_cast<std::uint32_t>(kHeaderBytes));
    writer.write(static_cast<std::uint32_t>(uvOffset));
    writer.write(std::uint32_t{0});
    writer.write(static_cast<std::uint32_t>(sections.thicknessScale.empty() ? 0 : thicknessOffset));
    writer.write(static_cast<std::uint32_t>(strands.colours.empty() ? 0 : colourOffset));
    for (int reserved = 0; reserved < 32; ++reserved) writer.write(std::uint32_t{0});
}

void writePositions(ByteWriter& writer, const PreparedStrands& strands, std::uint32_t points) {
    std::vector<float> values(strands.positions.size() * 4);
    for (std::size_t i = 0; i < strands.positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
            values[i * 4 + static_cast<std::size_t>(axis)] = strands.positions[i][axis];
        values[i * 4 + 3] = i % points < 2 ? 0.0f : 1.0f;
    }
    writer.writeArray(std::span<const float>(values));
}

void writeColours(ByteWriter& writer, const PreparedStrands& strands) {
    if (strands.colours.empty()) return;
    writer.align(8);
    std::vector<float> values;
    values.reserve(strands.colours.size() * 4);
    for (std::size_t i = 0; i < strands.colours.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) values.push_back(strands.colours[i][channel]);
        values.push_back(strands.transparency.empty() ? 1.0f : 1.0f - strands.transparency[i]);
    }
    writer.writeArray(std::span<const float>(values));
}

void addLimits(PreparedStrands& strands) {
    if (strands.positions.size() > kMaxVertices) {
        strands.findings.push_back(
            {Severity::Warning,
             fmt::format("{} vertices are more than one TressFX dispatch can take ({})",
                         strands.positions.size(), kMaxVertices),
             "strands", "split the groom, or export fewer guides and let TressFX generate follow hairs"});
    }
}

/// All of them or none, and none where `strands` may not replace what is at `path`. Returns their names.
Result<std::vector<std::string>> writeCompanions(const std::vector<TfxCompanion>& companions,
                                                 const std::filesystem::path& path,
                                                 std::span<const std::byte> strands) {
    std::vector<std::string> names;
    if (companions.empty()) return names;
    if (const auto mayBe = OutputFile::open(path, contentKind(strands)); !mayBe)
        return tl::unexpected(mayBe.error());
    std::vector<OutputFile> files;
    for (const TfxCompanion& companion : companions) {
        auto file = OutputFile::open(companion.path, contentKind(companion.bytes));
        if (!file) return tl::unexpected(file.error());
        if (auto status = file->write(companion.bytes); !status) return tl::unexpected(status.error());
        files.push_back(std::move(*file));
        names.push_back(companion.path.filename().string());
    }
    for (OutputFile& file : files) {
        if (auto status = file.finish(); !status) return tl::unexpected(status.error());
    }
    return names;
}

Result<ExportReport> writeTfx(const Groom& groom, const std::filesystem::path& path,
                              const StrandExportOptions& options) {
    const auto points = choosePoints(groom, options);
    if (!points) return tl::unexpected(inFile(points.error(), path.string()));
    auto strands = prepareStrands(groom, options, *points);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    if (strands->positions.size() * 32 + strands->strandCount() * 16 >
        std::numeric_limits<std::uint32_t>::max()) {
        return failIn(path.string(), {},
                      fmt::format("{} vertices need more than 4 GiB", strands->positions.size()),
                      "the offsets of .tfx have 32 bits: export fewer strands or vertices");
    }
    addLimits(*strands);
    TfxSections sections;
    sections.uvs = rootUvsOrZeros(groom, *strands);
    const auto scales = groom.strandAttributes.view<float>("thickness_scale");
    if (scales.size() == groom.strandCount()) {
        for (const std::uint32_t source : strands->sources) sections.thicknessScale.push_back(scales[source]);
    }

    ByteWriter writer;
    writer.reserve(kHeaderBytes + strands->positions.size() * 32 + strands->strandCount() * 16);
    writeHeader(writer, *strands, sections, *points);
    writePositions(writer, *strands, *points);
    for (const Vec2f& uv : sections.uvs) writer.writeArray(std::span<const float>(uv.data(), 2));
    writer.writeArray(std::span<const float>(sections.thicknessScale));
    writeColours(writer, *strands);
    // Before the strands, so that what is read back is what a loader will find.
    const auto companions = tfxCompanions(groom, *strands, options, path);
    auto written = writeCompanions(companions, path, writer.bytes());
    if (!written) return tl::unexpected(written.error());
    auto report = writeAndCompare(groom, std::move(*strands), options, path, std::move(writer).take());
    if (report) report->companions = std::move(*written);
    return report;
}

}  // namespace

HairWriter tfxWriter() {
    StrandExportOptions unreal;
    unreal.metresPerUnit = 0.01f;
    unreal.up = UpAxis::Z;
    unreal.pointsPerStrand = 16;
    return {
        "tfx",
        "TressFX .tfx",
        "root UV and thickness factor of each strand, colour and transparency of each point. Next to the "
        "file, bones of the roots and the skinned head (.tfxbone, .tfxmesh) if the head has bones",
        "4, 8, 16, 32 or 64 points on every strand",
        {{"tressfx", "TressFX", ".tfx version 4 in metres, Y up, resampled to 4, 8, 16, 32 or 64 points", {}},
         {"tressfx-unreal", "TressFX for Unreal", ".tfx in centimetres, Z up, with 16 points per strand",
          unreal}},
        writeTfx};
}

}  // namespace hairloom
