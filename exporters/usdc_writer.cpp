// SPDX-License-Identifier: GPL-3.0-or-later
// Binary USD: the same curves and attributes as in text.

#include "core/groom/file/json_reader.h"
#include "exporters/usd_curves.h"
#include "exporters/usdc_builder.h"

namespace hairloom {
namespace {

UsdcRep valueOf(UsdcBuilder& file, const ExportedAttribute& attribute, std::string_view type) {
    if (attribute.type == ExportedAttribute::Type::Number)
        return file.floats(attribute.numbers, attribute.components);
    if (attribute.type == ExportedAttribute::Type::Whole && type != "bool") return file.ints(attribute.whole);
    const std::vector<std::uint8_t> bytes(attribute.whole.begin(), attribute.whole.end());
    return file.bytes(bytes, type == "bool");
}

Result<ExportReport> writeUsdc(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    const std::vector<std::int32_t> counts = curveVertexCounts(*strands);
    const std::array<Vec3f, 2> extent = extentOf(*strands);
    const auto attributes = exportedAttributes(groom, *strands);

    UsdcBuilder file;
    const std::vector<std::string> top{"groom"}, below{"hair"};
    file.root({{"defaultPrim", file.token("groom")},
               {"metersPerUnit", file.number(readableDecimal(options.metresPerUnit))},
               {"upAxis", file.token(options.up == UpAxis::Z ? "Z" : "Y")},
               {"primChildren", file.tokens(top)}});
    file.prim(1, "groom",
              {{"specifier", file.definition()},
               {"typeName", file.token("Xform")},
               {"primChildren", file.tokens(below)}});
    std::vector<std::string> names{"type", "wrap", "extent", "curveVertexCounts", "points", "widths"};
    for (const ExportedAttribute& attribute : attributes)
        names.push_back("primvars:" + usdName(attribute.name));
    file.prim(2, "hair",
              {{"specifier", file.definition()},
               {"typeName", file.token("BasisCurves")},
               {"properties", file.tokens(names)}});
    for (const auto& [name, value] : {std::pair("type", "linear"), std::pair("wrap", "nonperiodic")})
        file.attribute(3, name,
                       {{"typeName", file.token("token")},
                        {"variability", file.uniform()},
                        {"default", file.token(value)}});
    const auto add = [&](const std::string& name, const char* type, UsdcRep value) {
        file.attribute(3, name, {{"typeName", file.token(type)}, {"default", value}});
    };
    add("extent", "float3[]", file.floats({extent[0].data(), 6}, 3));
    add("curveVertexCounts", "int[]", file.ints(counts));
    add("points", "point3f[]", file.floats({strands->positions[0].data(), strands->positions.size() * 3}, 3));
    file.attribute(3, "widths",
                   {{"typeName", file.token("float[]")},
                    {"interpolation", file.token("vertex")},
                    {"default", file.floats(strands->thickness, 1)}});
    for (const ExportedAttribute& attribute : attributes) {
        const std::string type(usdTypeOf(attribute));
        file.attribute(3, "primvars:" + usdName(attribute.name),
                       {{"typeName", file.token(type + "[]")},
                        {"interpolation", file.token(attribute.perPoint ? "vertex" : "uniform")},
                        {"default", valueOf(file, attribute, type)}});
    }
    return writeAndCompare(groom, std::move(*strands), options, path, file.finish());
}

}  // namespace

StrandWriter usdcWriter() {
    return {"usdc", "USD .usdc",         "what usda carries, in a tenth of the time",
            "none", usdTargets(".usdc"), writeUsdc};
}

}  // namespace hairloom
