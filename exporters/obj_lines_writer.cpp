// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ with an `l` for each strand, root first: what Blender, Houdini, Maya and scripts read as
// curves.

#include <fmt/format.h>

#include <iterator>

#include "exporters/obj_groups.h"

namespace hairloom {
namespace {

Result<ExportReport> writeObjLines(const Groom& groom, const std::filesystem::path& path,
                                   const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand, StrandOrder::layers);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    std::string text = fmt::format("# Hairloom, {} m in a unit, {} up\n", options.metresPerUnit,
                                   options.up == UpAxis::Z ? "Z" : "Y");
    text.reserve(strands->positions.size() * 48);
    const auto end = std::back_inserter(text);
    for (const Vec3f& p : strands->positions) fmt::format_to(end, "v {} {} {}\n", p.x(), p.y(), p.z());
    for (const ExportedPart& part : exportedParts(groom, *strands, isLegalInObj)) {
        text += objGroup(part);
        for (std::size_t s = part.firstStrand; s < part.firstStrand + part.strandCount; ++s) {
            text += 'l';
            for (std::uint32_t point = strands->offsets[s]; point < strands->offsets[s + 1]; ++point)
                fmt::format_to(end, " {}", point + 1);
            text += '\n';
        }
    }
    return writeAndCompare(groom, std::move(*strands), options, path, std::move(text));
}

}  // namespace

HairWriter objLinesWriter() {
    return {"obj-lines",
            "OBJ lines",
            "layers, as groups",
            "none",
            {{"plain", "OBJ lines", ".obj in metres, Y up, with one line per strand, root first", {}}},
            writeObjLines};
}

}  // namespace hairloom
