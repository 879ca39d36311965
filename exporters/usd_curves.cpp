// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/usd_curves.h"

#include <algorithm>

namespace hairloom {

std::string_view usdTypeOf(const ExportedAttribute& attribute) {
    if (attribute.name == "groom_guide" && attribute.type != ExportedAttribute::Type::Number) return "bool";
    if (attribute.type == ExportedAttribute::Type::Flag) return "uchar";
    if (attribute.type == ExportedAttribute::Type::Whole) return "int";
    if (attribute.isColour) return "color3f";
    if (attribute.name == "groom_root_uv" && attribute.components == 2) return "texCoord2f";
    constexpr std::array<std::string_view, 5> kFloats{"", "float", "float2", "float3", "float4"};
    return kFloats[attribute.components];
}

std::array<Vec3f, 2> extentOf(std::span<const Vec3f> positions) {
    Box3f bounds;
    for (const Vec3f& position : positions) bounds.extend(position);
    return {bounds.min(), bounds.max()};
}

std::vector<std::int32_t> UsdPart::vertexCounts(const PreparedStrands& strands) const {
    std::vector<std::int32_t> counts(strandCount);
    for (std::size_t s = 0; s < counts.size(); ++s)
        counts[s] = static_cast<std::int32_t>(strands.offsets[firstStrand + s + 1] -
                                              strands.offsets[firstStrand + s]);
    return counts;
}

std::array<Vec3f, 2> UsdPart::extent(const PreparedStrands& strands, std::span<const Vec3f> all) const {
    const std::array<Vec3f, 2> box = extentOf(points(all));
    const Vec3f half = Vec3f::Constant(0.5f * std::ranges::max(widths(strands)));
    return {box[0] - half, box[1] + half};
}

std::span<const float> UsdPart::numbers(const ExportedAttribute& attribute) const {
    const std::size_t size = attribute.components;
    return attribute.perPoint ? std::span(attribute.numbers).subspan(firstPoint * size, pointCount * size)
                              : std::span(attribute.numbers).subspan(firstStrand * size, strandCount * size);
}

std::span<const std::int32_t> UsdPart::wholes(const ExportedAttribute& attribute) const {
    return attribute.perPoint ? std::span(attribute.whole).subspan(firstPoint, pointCount)
                              : std::span(attribute.whole).subspan(firstStrand, strandCount);
}

std::vector<UsdPart> usdParts(const Groom& groom, const PreparedStrands& strands) {
    constexpr std::string_view kAlone = "hair";
    NameGiver giver(isLegalInUsd);
    std::vector<UsdPart> parts;
    for (const PreparedPart& prepared : strands.parts) {
        UsdPart part;
        const bool isNamed = prepared.layer < groom.layers.size();
        const std::string& layer = isNamed ? groom.layers[prepared.layer].name : Layer{}.name;
        part.name = strands.parts.size() == 1 ? std::string(kAlone) : giver.give(layer);
        // One layer of the name that layers have by themselves says nothing.
        if (part.name != layer && (strands.parts.size() > 1 || layer != Layer{}.name))
            part.displayName = layer;
        part.firstStrand = prepared.firstStrand;
        part.strandCount = prepared.strandCount;
        part.firstPoint = strands.offsets[part.firstStrand];
        part.pointCount = strands.offsets[part.firstStrand + part.strandCount] - part.firstPoint;
        parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<ExportTarget> usdTargets(const std::string& suffix) {
    StrandExportOptions blender, maya;
    blender.up = UpAxis::Z;
    maya.metresPerUnit = 0.01f;
    return {{"houdini", "Houdini, USD", suffix + " in metres, Y up", {}},
            {"blender", "Blender, USD", suffix + " in metres, Z up", blender},
            {"maya", "Maya, USD", suffix + " in centimetres, Y up", maya}};
}

}  // namespace hairloom
