// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ as Cinema 4D writes hair (thesis §4.1, Figure 7): a flat ribbon for each strand, its vertices
// L0 R0 L1 R1 … from root to tip, its faces counter-clockwise. The left edge is the strand itself.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/geometry/curve.h"
#include "exporters/obj_groups.h"

namespace hairloom {
namespace {

/// Readers find a ribbon's beginning by counting, so that all have as many points: those of the longest list.
std::uint32_t pointsOfAll(const Groom& groom, const StrandExportOptions& options) {
    if (options.pointsPerStrand != 0) return options.pointsPerStrand;
    std::uint32_t points = 2;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        points = std::max(points, groom.offsets[s + 1] - groom.offsets[s]);
    return points;
}

Result<ExportReport> writeObjC4d(const Groom& groom, const std::filesystem::path& path,
                                 const StrandExportOptions& options) {
    const std::uint32_t points = pointsOfAll(groom, options);
    auto strands = prepareStrands(groom, options, points, StrandOrder::layers);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    std::string text = fmt::format("# Hairloom, {} m in a unit, {} up\n", options.metresPerUnit,
                                   options.up == UpAxis::Z ? "Z" : "Y");
    text.reserve(strands->positions.size() * 112);
    const auto end = std::back_inserter(text);
    for (std::size_t first = 0; first < strands->positions.size(); first += points) {
        const auto strand = std::span(strands->positions).subspan(first, points);
        const auto frames = parallelTransportFrames(strand, Vec3f::UnitX());
        for (std::uint32_t i = 0; i < points; ++i) {
            const Vec3f right = strand[i] + strands->thickness[first + i] * frames[i].col(0);
            fmt::format_to(end, "v {} {} {}\nv {} {} {}\n", strand[i].x(), strand[i].y(), strand[i].z(),
                           right.x(), right.y(), right.z());
        }
    }
    for (const ExportedPart& part : exportedParts(groom, *strands, isLegalInObj)) {
        text += objGroup(part);
        for (std::size_t first = part.firstPoint; first < part.firstPoint + part.pointCount;
             first += points) {
            for (std::size_t left = 2 * first + 1; left + 2 < 2 * (first + points); left += 2)
                fmt::format_to(end, "f {} {} {} {}\n", left, left + 1, left + 3, left + 2);
        }
    }
    return writeAndCompare(groom, std::move(*strands), options, path, std::move(text));
}

}  // namespace

HairWriter objC4dWriter() {
    return {"obj-c4d",
            "Cinema 4D hair OBJ",
            "the width of each point, as the width of its ribbon; layers, as groups",
            "all strands have the same number of points",
            {{"plain", "Cinema 4D", ".obj in metres, Y up, with one ribbon per strand, root first", {}}},
            writeObjC4d};
}

}  // namespace hairloom
