// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/usd_curves.h"

#include <array>
#include <utility>

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

UsdMore usdMore(const Groom& groom, const PreparedStrands& strands, const StrandExportOptions& options,
                std::span<const ExportedPart> parts, const std::string& physics) {
    UsdMore more;
    more.ofParts.resize(parts.size());
    if (options.physics) {
        UsdPhysics made = usdPhysics(groom, strands, parts, physics);
        more.ofParts = std::move(made.ofParts);
        more.beside.push_back(std::move(made.beside));
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (parts[p].areGuides)
            more.ofParts[p].fields.push_back({"token", "purpose", true, {}, std::string("guide")});
    }
    return more;
}

std::array<Vec3f, 2> extentOf(std::span<const Vec3f> positions) {
    Box3f bounds;
    for (const Vec3f& position : positions) bounds.extend(position);
    return {bounds.min(), bounds.max()};
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
