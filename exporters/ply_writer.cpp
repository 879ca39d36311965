// SPDX-License-Identifier: GPL-3.0-or-later
// PLY with a list of vertices for each strand, little-endian: what MeshLab, Open3D and research code read of
// points, and a loop of three lines of the rest.

#include <fmt/format.h>

#include "exporters/exported_attributes.h"

namespace hairloom {
namespace {

/// Attributes of points that are single numbers.
bool isCarried(const ExportedAttribute& attribute) {
    return attribute.perPoint && attribute.components == 1 &&
           attribute.type == ExportedAttribute::Type::Number;
}

Result<ExportReport> writePly(const Groom& groom, const std::filesystem::path& path,
                              const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    auto attributes = exportedAttributes(groom, *strands, plyNames());
    std::erase_if(attributes, [](const ExportedAttribute& attribute) { return !isCarried(attribute); });
    std::string head = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment Hairloom, {} m in a unit, {} up\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\nproperty float width\n",
        options.metresPerUnit, options.up == UpAxis::Z ? "Z" : "Y", strands->positions.size());
    const bool hasColours = !strands->colours.empty();
    if (hasColours) head += "property float red\nproperty float green\nproperty float blue\n";
    for (const ExportedAttribute& attribute : attributes) head += "property float " + attribute.name + "\n";
    head += fmt::format("element strand {}\nproperty list uint uint vertex_indices\nend_header\n",
                        strands->strandCount());
    ByteWriter writer;
    writer.reserve(head.size() + strands->positions.size() * (32 + 4 * attributes.size()) +
                   4 * strands->strandCount());
    writer.writeArray(std::span<const char>(head));
    for (std::size_t point = 0; point < strands->positions.size(); ++point) {
        writer.writeArray(std::span<const float>(strands->positions[point].data(), 3));
        writer.write(strands->thickness[point]);
        if (hasColours) writer.writeArray(std::span<const float>(strands->colours[point].data(), 3));
        for (const ExportedAttribute& attribute : attributes) writer.write(attribute.numbers[point]);
    }
    for (std::size_t strand = 0; strand < strands->strandCount(); ++strand) {
        writer.write(strands->offsets[strand + 1] - strands->offsets[strand]);
        for (std::uint32_t point = strands->offsets[strand]; point < strands->offsets[strand + 1]; ++point)
            writer.write(point);
    }
    return writeAndCompare(groom, std::move(*strands), options, path, std::move(writer).take());
}

}  // namespace

HairWriter plyWriter() {
    return {"ply",
            "PLY strands",
            "width and colour of each point; scalar point attributes under their names",
            "none",
            {{"plain", "PLY strands", ".ply in metres, Y up, with a list of vertices per strand", {}}},
            writePly};
}

}  // namespace hairloom
