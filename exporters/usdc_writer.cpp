// SPDX-License-Identifier: GPL-3.0-or-later
// Binary USD: the same curves and attributes as in text.

#include "core/groom/file/json_reader.h"
#include "exporters/usd_curves.h"
#include "exporters/usdc_builder.h"

namespace hairloom {
namespace {

UsdcRep valueOf(UsdcBuilder& file, const ExportedPart& part, const ExportedAttribute& attribute,
                std::string_view type) {
    if (attribute.type == ExportedAttribute::Type::Number)
        return file.floats(part.numbers(attribute), attribute.components);
    const auto whole = part.wholes(attribute);
    if (type == "int") return file.ints(whole);
    const std::vector<std::uint8_t> bytes(whole.begin(), whole.end());
    return file.bytes(bytes, type == "bool");
}

std::span<const float> numbersOf(std::span<const Vec3f> values) {
    return {values[0].data(), values.size() * 3};
}

void writeRoot(UsdcBuilder& file, const PreparedStrands& strands, const StrandExportOptions& options) {
    const std::vector<std::string> top{"groom"};
    UsdcBuilder::Fields head{{"defaultPrim", file.token("groom")},
                             {"metersPerUnit", file.number(readableDecimal(options.metresPerUnit))},
                             {"upAxis", file.token(options.up == UpAxis::Z ? "Z" : "Y")},
                             {"primChildren", file.tokens(top)}};
    if (options.frames) {
        const double first = options.frames->first, rate = options.frames->framesPerSecond;
        head.emplace_back("startTimeCode", file.number(first));
        head.emplace_back("endTimeCode", file.number(first + static_cast<double>(strands.frames.size() - 1)));
        head.emplace_back("framesPerSecond", file.number(rate));
        head.emplace_back("timeCodesPerSecond", file.number(rate));
    }
    file.root(head);
}

class PartWriter {
  public:
    PartWriter(UsdcBuilder& file, const PreparedStrands& strands, const StrandExportOptions& options)
        : file_(file), strands_(strands) {
        for (std::size_t f = 0; f < strands.frames.size(); ++f)
            times_.push_back(options.frames->first + static_cast<double>(f));
    }

    void write(const ExportedPart& part, std::span<const ExportedAttribute> attributes) {
        std::vector<std::string> names{"type", "wrap", "extent", "curveVertexCounts", "points", "widths"};
        for (const ExportedAttribute& attribute : attributes) names.push_back("primvars:" + attribute.name);
        UsdcBuilder::Fields fields{{"specifier", file_.definition()},
                                   {"typeName", file_.token("BasisCurves")},
                                   {"properties", file_.tokens(names)}};
        if (!part.displayName.empty()) fields.emplace_back("displayName", file_.string(part.displayName));
        file_.prim(2, part.name, fields);
        for (const auto& [name, value] : {std::pair("type", "linear"), std::pair("wrap", "nonperiodic")})
            file_.attribute(3, name,
                            {{"typeName", file_.token("token")},
                             {"variability", file_.uniform()},
                             {"default", file_.token(value)}});
        writePoints(part);
        file_.attribute(3, "widths",
                        {{"typeName", file_.token("float[]")},
                         {"interpolation", file_.token("vertex")},
                         {"default", file_.floats(part.widths(strands_), 1)}});
        for (const ExportedAttribute& attribute : attributes) writeAttribute(part, attribute);
    }

  private:
    void writePoints(const ExportedPart& part) {
        const auto add = [&](const std::string& name, const char* type, UsdcRep value,
                             std::span<const UsdcRep> frames = {}) {
            UsdcBuilder::Fields fields{{"typeName", file_.token(type)}, {"default", value}};
            if (!frames.empty()) fields.emplace_back("timeSamples", file_.samples(times_, frames));
            file_.attribute(3, name, fields);
        };
        const auto box = [&](std::span<const Vec3f> all) {
            const std::array<Vec3f, 2> extent = part.extent(strands_, all);
            return file_.floats({extent[0].data(), 6}, 3);
        };
        const auto points = [&](std::span<const Vec3f> all) {
            return file_.floats(numbersOf(part.points(all)), 3);
        };
        std::vector<UsdcRep> extents, shapes;
        for (const std::vector<Vec3f>& frame : strands_.frames) {
            extents.push_back(box(frame));
            shapes.push_back(points(frame));
        }
        add("extent", "float3[]", box(strands_.positions), extents);
        add("curveVertexCounts", "int[]", file_.ints(part.vertexCounts(strands_)));
        add("points", "point3f[]", points(strands_.positions), shapes);
    }

    void writeAttribute(const ExportedPart& part, const ExportedAttribute& attribute) {
        const std::string type(usdTypeOf(attribute));
        UsdcBuilder::Fields fields{{"typeName", file_.token(type + "[]")},
                                   {"interpolation", file_.token(attribute.perPoint ? "vertex" : "uniform")},
                                   {"default", valueOf(file_, part, attribute, type)}};
        if (!attribute.original.empty()) fields.emplace_back("displayName", file_.string(attribute.original));
        file_.attribute(3, "primvars:" + attribute.name, fields);
    }

    UsdcBuilder& file_;
    const PreparedStrands& strands_;
    std::vector<double> times_;
};

Result<ExportReport> writeUsdc(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) {
    auto strands = prepareStrands(groom, options, options.pointsPerStrand, true);
    if (!strands) return tl::unexpected(inFile(strands.error(), path.string()));
    const auto attributes = exportedAttributes(groom, *strands, usdNames());
    const std::vector<ExportedPart> parts = exportedParts(groom, *strands, isLegalInUsd);
    UsdcBuilder file;
    file.reserve(roomOf(*strands, attributes));
    writeRoot(file, *strands, options);
    std::vector<std::string> names;
    for (const ExportedPart& part : parts) names.push_back(part.name);
    file.prim(1, "groom",
              {{"specifier", file.definition()},
               {"typeName", file.token("Xform")},
               {"primChildren", file.tokens(names)}});
    PartWriter writer(file, *strands, options);
    for (const ExportedPart& part : parts) writer.write(part, attributes);
    return writeAndCompare(groom, std::move(*strands), options, path, file.finish());
}

}  // namespace

HairWriter usdcWriter() {
    HairWriter writer{"usdc", "USD .usdc",         "like usda, in a tenth of the time",
                      "none", usdTargets(".usdc"), writeUsdc};
    writer.animates = true;
    return writer;
}

}  // namespace hairloom
