// SPDX-License-Identifier: GPL-3.0-or-later
// USD as text: a BasisCurves of polylines for each layer, whose widths and attributes have a value a point or
// a curve.

#include <fmt/format.h>

#include "exporters/usd_curves.h"
#include "exporters/usda_numbers.h"

namespace hairloom {
namespace {

/// In quotation marks.
std::string inQuotes(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            out += ' ';
        else
            out += c;
    }
    return out + '"';
}

std::string displayLine(const std::string& name, int indent) {
    return name.empty() ? std::string()
                        : fmt::format("{}displayName = {}\n",
                                      std::string(static_cast<std::size_t>(indent), ' '), inQuotes(name));
}

void writeAttribute(std::string& out, const ExportedPart& part, const ExportedAttribute& attribute) {
    out += fmt::format("        {}[] primvars:{} = ", usdTypeOf(attribute), attribute.name);
    if (attribute.type == ExportedAttribute::Type::Number)
        writeNumbers(out, part.numbers(attribute), attribute.components);
    else
        writeNumbers(out, part.wholes(attribute), 1);
    out += fmt::format(" (\n{}            interpolation = \"{}\"\n        )\n",
                       displayLine(attribute.original, 12), attribute.perPoint ? "vertex" : "uniform");
}

/// What strands that move have at each frame beside the first, which stands for all who look at no time.
void writeSamples(std::string& out, const ExportedPart& part, const PreparedStrands& strands,
                  const StrandFrames& frames) {
    const auto write = [&](std::string_view name, const auto& valueOf) {
        out += fmt::format("        {}.timeSamples = {{\n", name);
        for (std::size_t f = 0; f < strands.frames.size(); ++f) {
            out += fmt::format("            {}: ", frames.first + static_cast<double>(f));
            const auto value = valueOf(strands.frames[f]);
            writeNumbers(out, numbersOf(value), 3);
            out += ",\n";
        }
        out += "        }\n";
    };
    write("float3[] extent", [&](const std::vector<Vec3f>& points) { return part.extent(strands, points); });
    write("point3f[] points", [&](const std::vector<Vec3f>& points) { return part.points(points); });
}

/// The lines of the head that say which times there are.
std::string timesInHead(const StrandExportOptions& options) {
    if (!options.frames) return {};
    const double last = options.frames->first + static_cast<double>(options.frames->points.size() - 1);
    return fmt::format(
        "    endTimeCode = {}\n    framesPerSecond = {}\n    startTimeCode = {}\n    timeCodesPerSecond = "
        "{}\n",
        last, options.frames->framesPerSecond, options.frames->first, options.frames->framesPerSecond);
}

void writePart(std::string& out, const ExportedPart& part, const PreparedStrands& strands,
               std::span<const ExportedAttribute> attributes, const StrandExportOptions& options) {
    out += fmt::format("    def BasisCurves \"{}\"{}\n    {{\n", part.name,
                       part.displayName.empty() ? "" : " (\n" + displayLine(part.displayName, 8) + "    )");
    out +=
        "        uniform token type = \"linear\"\n        uniform token wrap = \"nonperiodic\"\n"
        "        float3[] extent = ";
    const std::array<Vec3f, 2> extent = part.extent(strands, strands.positions);
    writeNumbers(out, numbersOf(extent), 3);
    out += "\n        int[] curveVertexCounts = ";
    const std::vector<std::int32_t> counts = part.vertexCounts(strands);
    writeNumbers(out, std::span<const std::int32_t>(counts), 1);
    out += "\n        point3f[] points = ";
    writeNumbers(out, numbersOf(part.points(strands.positions)), 3);
    out += '\n';
    if (options.frames) writeSamples(out, part, strands, *options.frames);
    out += "        float[] widths = ";
    writeNumbers(out, part.widths(strands), 1);
    out += " (\n            interpolation = \"vertex\"\n        )\n";
    for (const ExportedAttribute& attribute : attributes) writeAttribute(out, part, attribute);
    out += "    }\n";
}

std::string usdaText(const Groom& groom, PreparedStrands& strands, const StrandExportOptions& options) {
    std::string out = fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"groom\"\n    doc = \"Hairloom\"\n{}    metersPerUnit = {}\n    "
        "upAxis = \"{}\"\n)\n\n"
        "def Xform \"groom\"\n{{\n",
        timesInHead(options), options.metresPerUnit, options.up == UpAxis::Z ? "Z" : "Y");
    // About what points and widths take as text.
    out.reserve(strands.positions.size() * 48 * (1 + strands.frames.size()));
    const auto attributes = exportedAttributes(groom, strands, usdNames());
    for (const ExportedPart& part : exportedParts(groom, strands, isLegalInUsd))
        writePart(out, part, strands, attributes, options);
    out += "}\n";
    return out;
}

Result<ExportReport> writeUsda(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand, true);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    std::string text = usdaText(groom, *strands, options);
    return writeAndCompare(groom, std::move(*strands), options, path, std::move(text));
}

}  // namespace

HairWriter usdaWriter() {
    HairWriter writer{"usda",
                      "USD .usda",
                      "width and colour of each point; root UV, id, group and guide flag of each strand; "
                      "layers; attributes of "
                      "any name",
                      "none",
                      usdTargets(".usda"),
                      writeUsda};
    writer.animates = true;
    return writer;
}

}  // namespace hairloom
