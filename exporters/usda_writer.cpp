// SPDX-License-Identifier: GPL-3.0-or-later
// USD as text: one BasisCurves of polylines, whose widths and attributes have a value a point or a curve.

#include <fmt/format.h>

#include "exporters/usd_curves.h"
#include "exporters/usda_numbers.h"

namespace hairloom {
namespace {

void writeAttribute(std::string& out, const ExportedAttribute& attribute) {
    out += fmt::format("        {}[] primvars:{} = ", usdTypeOf(attribute), usdName(attribute.name));
    if (attribute.type == ExportedAttribute::Type::Number)
        writeNumbers(out, std::span<const float>(attribute.numbers), attribute.components);
    else
        writeNumbers(out, std::span<const std::int32_t>(attribute.whole), 1);
    out += fmt::format(" (\n            interpolation = \"{}\"\n        )\n",
                       attribute.perPoint ? "vertex" : "uniform");
}

/// What strands that move have at each frame beside the first, which stands for all who look at no time.
void writeSamples(std::string& out, const PreparedStrands& strands, const StrandFrames& frames) {
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
    write("float3[] extent", [](const std::vector<Vec3f>& points) { return extentOf(points); });
    write("point3f[] points", [](const std::vector<Vec3f>& points) { return std::span(points); });
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

std::string usdaText(const Groom& groom, const PreparedStrands& strands, const StrandExportOptions& options) {
    std::string out = fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"groom\"\n    doc = \"Hairloom\"\n{}    metersPerUnit = {}\n    "
        "upAxis = \"{}\"\n)\n\n"
        "def Xform \"groom\"\n{{\n    def BasisCurves \"hair\"\n    {{\n"
        "        uniform token type = \"linear\"\n        uniform token wrap = \"nonperiodic\"\n",
        timesInHead(options), options.metresPerUnit, options.up == UpAxis::Z ? "Z" : "Y");
    // About what points and widths take as text.
    out.reserve(strands.positions.size() * 48 * (1 + strands.frames.size()));
    const std::vector<std::int32_t> counts = curveVertexCounts(strands);
    const std::array<Vec3f, 2> extent = extentOf(strands.positions);
    out += "        float3[] extent = ";
    writeNumbers(out, numbersOf(extent), 3);
    out += "\n        int[] curveVertexCounts = ";
    writeNumbers(out, std::span<const std::int32_t>(counts), 1);
    out += "\n        point3f[] points = ";
    writeNumbers(out, numbersOf(strands.positions), 3);
    out += '\n';
    if (options.frames) writeSamples(out, strands, *options.frames);
    out += "        float[] widths = ";
    writeNumbers(out, std::span<const float>(strands.thickness), 1);
    out += " (\n            interpolation = \"vertex\"\n        )\n";
    for (const ExportedAttribute& attribute : exportedAttributes(groom, strands))
        writeAttribute(out, attribute);
    out += "    }\n}\n";
    return out;
}

Result<ExportReport> writeUsda(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    std::string text = usdaText(groom, *strands, options);
    return writeAndCompare(groom, std::move(*strands), options, path, std::move(text));
}

}  // namespace

StrandWriter usdaWriter() {
    StrandWriter writer{
        "usda",
        "USD .usda",
        "width and colour of each point; root UV, id, group and guide flag of each strand; all attributes",
        "none",
        usdTargets(".usda"),
        writeUsda};
    writer.animates = true;
    return writer;
}

}  // namespace hairloom
