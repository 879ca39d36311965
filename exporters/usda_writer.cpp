// SPDX-License-Identifier: GPL-3.0-or-later
// USD as text: a BasisCurves of polylines for each layer, whose widths and attributes have a value a point or
// a curve.

#include <fmt/format.h>

#include "exporters/usd_curves.h"
#include "exporters/usd_scene.h"
#include "exporters/usda_numbers.h"
#include "importers/authored_settings.h"

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
                  const StrandExportOptions& options) {
    const StrandFrames& frames = *options.frames;
    const auto write = [&](std::string_view name, const auto& valueOf) {
        out += fmt::format("        {}.timeSamples = {{\n", name);
        for (std::size_t f = 0; f < strands.frames.size() && !options.watch.isCancelled(); ++f) {
            out += fmt::format("            {}: ", frames.numberOf(f));
            const auto value = valueOf(strands.frames[f]);
            writeNumbers(out, numbersOf(value), 3);
            out += ",\n";
        }
        out += "        }\n";
    };
    write("float3[] extent", [&](const std::vector<Vec3f>& points) { return part.extent(strands, points); });
    write("point3f[] points", [&](const std::vector<Vec3f>& points) { return part.points(points); });
    std::vector<std::span<const Vec3f>> shapes;
    for (const std::vector<Vec3f>& frame : strands.frames) shapes.push_back(part.points(frame));
    if (shapes.size() < 2) return;
    out += "        vector3f[] velocities.timeSamples = {\n";
    for (std::size_t f = 0; f < shapes.size() && !options.watch.isCancelled(); ++f) {
        out += fmt::format("            {}: ", frames.numberOf(f));
        const std::vector<Vec3f> velocities = pointVelocities(shapes, f, frames);
        writeNumbers(out, numbersOf(velocities), 3);
        out += ",\n";
    }
    out += "        }\n";
}

std::string inputText(const UsdShaderInput& input) {
    std::string out = fmt::format("                {} inputs:{}", input.type, input.name);
    if (!input.connection.empty()) return out + fmt::format(".connect = <{}>\n", input.connection);
    out += " = ";
    if (input.numbers.empty()) return out + inQuotes(input.text) + '\n';
    if (input.numbers.size() == 1) return out + fmt::format("{}\n", input.numbers[0]);
    return out + fmt::format("({})\n", fmt::join(input.numbers, ", "));
}

std::string materialsText(const std::string& folder, const UsdMaterials& materials) {
    std::string out = fmt::format("    def Scope \"{}\"\n    {{\n", folder);
    for (const UsdMaterial& material : materials.all) {
        out += fmt::format(
            "        def Material \"{}\"\n        {{\n            token outputs:surface.connect = <{}>\n"
            "            token outputs:mtlx:surface.connect = <{}>\n",
            material.name, material.preview, material.surface);
        for (const UsdShader& shader : material.shaders) {
            out += fmt::format(
                "            def Shader \"{}\"\n            {{\n                uniform token info:id = "
                "\"{}\"\n",
                shader.name, shader.id);
            for (const UsdShaderInput& input : shader.inputs) out += inputText(input);
            for (const auto& [type, name] : shader.outputs)
                out += fmt::format("                {} outputs:{}\n", type, name);
            out += "            }\n";
        }
        out += "        }\n";
    }
    return out + "    }\n";
}

std::string scalpText(const std::string& name, const UsdScalp& scalp) {
    if (scalp.empty()) return {};
    std::string out = fmt::format(
        "    def Mesh \"{}\"\n    {{\n        uniform token subdivisionScheme = \"none\"\n"
        "        uniform bool doubleSided = 1\n        float3[] extent = ",
        name);
    const std::array<Vec3f, 2> extent = extentOf(scalp.points);
    writeNumbers(out, numbersOf(extent), 3);
    out += "\n        int[] faceVertexCounts = ";
    writeNumbers(out, std::span<const std::int32_t>(scalp.faceVertexCounts), 1);
    out += "\n        int[] faceVertexIndices = ";
    writeNumbers(out, std::span<const std::int32_t>(scalp.faceVertexIndices), 1);
    out += "\n        point3f[] points = ";
    writeNumbers(out, numbersOf(scalp.points), 3);
    out += "\n        normal3f[] normals = ";
    writeNumbers(out, numbersOf(scalp.normals), 3);
    out += " (\n            interpolation = \"vertex\"\n        )\n";
    if (!scalp.uvs.empty()) {
        out += "        texCoord2f[] primvars:st = ";
        writeNumbers(out, std::span<const float>(scalp.uvs), 2);
        out += " (\n            interpolation = \"faceVarying\"\n        )\n";
    }
    return out + "    }\n";
}

/// The lines of the head that say which times there are.
std::string timesInHead(const StrandExportOptions& options) {
    if (!options.frames) return {};
    const double last = options.frames->first + static_cast<double>(options.frames->frameCount() - 1);
    return fmt::format(
        "    endTimeCode = {}\n    framesPerSecond = {}\n    startTimeCode = {}\n    "
        "timeCodesPerSecond = "
        "{}\n",
        last, options.frames->framesPerSecond, options.frames->first, options.frames->framesPerSecond);
}

std::string schemasText(const std::vector<std::string>& schemas) {
    std::string list;
    for (const std::string& schema : schemas) list += (list.empty() ? "" : ", ") + inQuotes(schema);
    return fmt::format("prepend apiSchemas = [{}]\n", list);
}

/// Relationships and attributes, a line each.
void writeFields(std::string& out, const UsdNode& node, std::size_t indent) {
    const std::string space(indent, ' ');
    for (const auto& [name, path] : node.targets) out += fmt::format("{}rel {} = <{}>\n", space, name, path);
    for (const UsdField& field : node.fields) {
        out += fmt::format("{}{}{} {} = ", space, field.isUniform ? "uniform " : "", field.type, field.name);
        if (const auto* number = std::get_if<float>(&field.value)) {
            out += fmt::format("{}", *number);
        } else if (const auto* vector = std::get_if<Vec3f>(&field.value)) {
            out += fmt::format("({}, {}, {})", vector->x(), vector->y(), vector->z());
        } else if (const auto* text = std::get_if<std::string>(&field.value)) {
            out += inQuotes(*text);
        } else if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&field.value)) {
            writeNumbers(out, std::span<const std::int32_t>(*whole), 1);
        } else {
            const auto& vectors = std::get<std::vector<Vec3f>>(field.value);
            writeNumbers(out, vectors.empty() ? std::span<const float>() : numbersOf(vectors), 3);
        }
        if (!field.interpolation.empty())
            out += fmt::format(" (\n{0}    interpolation = \"{1}\"\n{0})", space, field.interpolation);
        out += '\n';
    }
}

void writeNode(std::string& out, const UsdNode& node, std::size_t indent) {
    const std::string space(indent, ' ');
    out += fmt::format("{}def {} \"{}\"", space, node.type, node.name);
    if (!node.schemas.empty()) out += fmt::format(" (\n{0}    {1}{0})", space, schemasText(node.schemas));
    out += fmt::format("\n{}{{\n", space);
    writeFields(out, node, indent + 4);
    for (const UsdNode& child : node.children) writeNode(out, child, indent + 4);
    out += space + "}\n";
}

void writePart(std::string& out, const ExportedPart& part, const PreparedStrands& strands,
               std::span<const ExportedAttribute> attributes, const StrandExportOptions& options,
               const UsdMaterial& material, const UsdNode& more) {
    std::vector<std::string> schemas{"MaterialBindingAPI"};
    schemas.insert(schemas.end(), more.schemas.begin(), more.schemas.end());
    out += fmt::format(
        "    def BasisCurves \"{}\" (\n        {}{}    "
        ")\n    "
        "{{\n        rel material:binding = <{}>\n",
        part.name, schemasText(schemas), displayLine(part.displayName, 8), material.path);
    writeFields(out, more, 8);
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
    if (options.frames) writeSamples(out, part, strands, options);
    out += "        float[] widths = ";
    writeNumbers(out, part.widths(strands), 1);
    out += " (\n            interpolation = \"vertex\"\n        )\n";
    for (const ExportedAttribute& attribute : attributes) writeAttribute(out, part, attribute);
    out += "    }\n";
}

std::string usdaText(const Groom& groom, PreparedStrands& strands, const StrandExportOptions& options) {
    std::string out = fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"groom\"\n    doc = \"Hairloom\"\n{}    metersPerUnit = "
        "{}\n    "
        "upAxis = \"{}\"\n)\n\n"
        "def Xform \"groom\" (\n    customData = {{\n        dictionary {} = {{\n",
        timesInHead(options), options.metresPerUnit, options.up == UpAxis::Z ? "Z" : "Y", kUsdDictionary);
    // About what points and widths take as text.
    out.reserve(strands.positions.size() * 48 * (1 + strands.frames.size()));
    const bool hasOperators = usdHasOperators(groom, options);
    for (const auto& [name, text] : usdSettings(groom, strands, hasOperators))
        out += fmt::format("            string {} = {}\n", name, inQuotes(text));
    out += "        }\n    }\n)\n{\n";
    const auto attributes = exportedAttributes(groom, strands, usdNames(hasOperators));
    const std::vector<ExportedPart> parts = exportedParts(groom, strands, isLegalInUsd);
    const UsdBeside beside = usdBeside(parts);
    const UsdMaterials materials = usdMaterials(groom, strands, attributes, beside.materials);
    const UsdMore more = usdMore(groom, strands, options, parts, beside.physics);
    for (std::size_t p = 0; p < parts.size(); ++p)
        writePart(out, parts[p], strands, attributes, options, materials.all[materials.ofPart[p]],
                  more.ofParts[p]);
    out += scalpText(beside.scalp, usdScalp(groom, options)) + materialsText(beside.materials, materials);
    for (const UsdNode& node : more.beside) writeNode(out, node, 4);
    out += "}\n";
    return out;
}

Result<ExportReport> writeUsda(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand, StrandOrder::layersAndGuides);
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
    writer.keepsGuides = true;
    writer.holdsPhysics = true;
    return writer;
}

}  // namespace hairloom
