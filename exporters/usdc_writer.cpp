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
    const std::array<Vec3f, 2> extent = extentOf(strands->positions);
    const auto attributes = exportedAttributes(groom, *strands);
    std::vector<double> times;
    for (std::size_t f = 0; f < strands->frames.size(); ++f)
        times.push_back(options.frames->first + static_cast<double>(f));

    UsdcBuilder file;
    file.reserve(roomOf(*strands, attributes));
    const std::vector<std::string> top{"groom"}, below{"hair"};
    UsdcBuilder::Fields head{{"defaultPrim", file.token("groom")},
                             {"metersPerUnit", file.number(readableDecimal(options.metresPerUnit))},
                             {"upAxis", file.token(options.up == UpAxis::Z ? "Z" : "Y")},
                             {"primChildren", file.tokens(top)}};
    if (options.frames) {
        const double first = options.frames->first, rate = options.frames->framesPerSecond;
        head.emplace_back("startTimeCode", file.number(first));
        head.emplace_back("endTimeCode",
                          file.number(first + static_cast<double>(strands->frames.size() - 1)));
        head.emplace_back("framesPerSecond", file.number(rate));
        head.emplace_back("timeCodesPerSecond", file.number(rate));
    }
    file.root(head);
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
    const auto add = [&](const std::string& name, const char* type, UsdcRep value,
                         std::span<const UsdcRep> frames = {}) {
        UsdcBuilder::Fields fields{{"typeName", file.token(type)}, {"default", value}};
        if (!frames.empty()) fields.emplace_back("timeSamples", file.samples(times, frames));
        file.attribute(3, name, fields);
    };
    std::vector<UsdcRep> extents, points;
    for (const std::vector<Vec3f>& frame : strands->frames) {
        const std::array<Vec3f, 2> box = extentOf(frame);
        extents.push_back(file.floats({box[0].data(), 6}, 3));
        points.push_back(file.floats({frame[0].data(), frame.size() * 3}, 3));
    }
    add("extent", "float3[]", file.floats({extent[0].data(), 6}, 3), extents);
    add("curveVertexCounts", "int[]", file.ints(counts));
    add("points", "point3f[]", file.floats({strands->positions[0].data(), strands->positions.size() * 3}, 3),
        points);
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
    StrandWriter writer{"usdc", "USD .usdc",         "like usda, in a tenth of the time",
                        "none", usdTargets(".usdc"), writeUsdc};
    writer.animates = true;
    return writer;
}

}  // namespace hairloom
