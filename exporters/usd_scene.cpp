// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/usd_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/hash.h"
#include "importers/authored_settings.h"

namespace hairloom {
namespace {

UsdShaderInput number(const char* type, const char* name, std::vector<float> numbers) {
    return {type, name, std::move(numbers), {}, {}};
}
UsdShaderInput connected(const char* type, const char* name, std::string output) {
    return {type, name, {}, {}, std::move(output)};
}

/// By pigment where the shading model is one of fibres and not dyed, else by the colour that is shown.
bool isPigmented(const HairMaterial& material) {
    return material.shadingModel != ShadingModel::kajiya && material.colourSource == ColourSource::melanin;
}

/// Light that a millimetre of the pigment lets through, as MaterialX has it: exp(−σ) of eumelanin and of
/// pheomelanin.
Vec3f pigmentColour(float eumelanin, float pheomelanin) {
    const Vec3f absorbed =
        eumelanin * Vec3f(0.419f, 0.697f, 1.37f) + pheomelanin * Vec3f(0.187f, 0.4f, 1.05f);
    return (-absorbed).array().exp();
}

UsdMaterial materialOf(const std::string& folder, const std::string& name, const HairMaterial& own,
                       bool hasColours) {
    UsdMaterial made;
    made.name = name;
    made.path = "/groom/" + folder + "/" + name;
    const auto at = [&](const char* output) { return made.path + "/" + output; };
    const bool pigmented = isPigmented(own);
    const Vec3f shown = pigmented ? pigmentColour(own.eumelanin, own.pheomelanin)
                                  : Vec3f(0.5f * (own.rootColour + own.tipColour));
    const std::vector<float> colour{shown.x(), shown.y(), shown.z()};

    UsdShader preview{"preview", "UsdPreviewSurface", {}, {{"token", "surface"}}};
    if (hasColours) {
        preview.inputs.push_back(connected("color3f", "diffuseColor", at("colour.outputs:result")));
        UsdShader reader{"colour", "UsdPrimvarReader_float3", {}, {{"float3", "result"}}};
        reader.inputs.push_back({"string", "varname", {}, "groom_color", {}});
        reader.inputs.push_back(number("float3", "fallback", colour));
        made.shaders.push_back(std::move(reader));
    } else {
        preview.inputs.push_back(number("color3f", "diffuseColor", colour));
    }
    preview.inputs.push_back(number("float", "roughness", {own.longitudinalRoughness}));
    preview.inputs.push_back(number("float", "ior", {own.indexOfRefraction}));
    made.shaders.push_back(std::move(preview));
    made.preview = at("preview.outputs:surface");

    UsdShader absorption{"absorption", "", {}, {{"float3", "absorption"}}};
    if (pigmented) {
        // The node takes 1 − exp(−c) of the concentration c.
        const float all = own.eumelanin + own.pheomelanin;
        absorption.id = "ND_deon_hair_absorption_from_melanin";
        absorption.inputs = {number("float", "melanin_concentration", {1 - std::exp(-all)}),
                             number("float", "melanin_redness", {all > 0 ? own.pheomelanin / all : 0.0f})};
    } else {
        absorption.id = "ND_chiang_hair_absorption_from_color";
        absorption.inputs = {number("color3f", "color", colour),
                             number("float", "azimuthal_roughness", {own.azimuthalRoughness})};
    }
    UsdShader roughness{"roughness",
                        "ND_chiang_hair_roughness",
                        {number("float", "longitudinal", {own.longitudinalRoughness}),
                         number("float", "azimuthal", {own.azimuthalRoughness})},
                        {{"float2", "roughness_R"}, {"float2", "roughness_TT"}, {"float2", "roughness_TRT"}}};
    constexpr float kHalfTurn = 180;
    UsdShader fibre{"fibre",
                    "ND_chiang_hair_bsdf",
                    {number("float", "ior", {own.indexOfRefraction}),
                     // 0 to 1 are −90° to 90° of tilt.
                     number("float", "cuticle_angle", {0.5f + own.scaleTiltDegrees / kHalfTurn}),
                     connected("float2", "roughness_R", at("roughness.outputs:roughness_R")),
                     connected("float2", "roughness_TT", at("roughness.outputs:roughness_TT")),
                     connected("float2", "roughness_TRT", at("roughness.outputs:roughness_TRT")),
                     connected("float3", "absorption_coefficient", at("absorption.outputs:absorption"))},
                    {{"token", "out"}}};
    UsdShader surface{
        "surface", "ND_surface", {connected("token", "bsdf", at("fibre.outputs:out"))}, {{"token", "out"}}};
    for (UsdShader* shader : {&absorption, &roughness, &fibre, &surface})
        made.shaders.push_back(std::move(*shader));
    made.surface = at("surface.outputs:out");
    return made;
}

}  // namespace

UsdBeside usdBeside(std::span<const ExportedPart> parts) {
    NameGiver names(isLegalInUsd);
    for (const ExportedPart& part : parts) names.reserve(part.name);
    return {names.give("scalp"), names.give("materials"), names.give("physics")};
}

UsdMaterials usdMaterials(const Groom& groom, const PreparedStrands& strands,
                          std::span<const ExportedAttribute> attributes, const std::string& folder) {
    const bool hasColours = std::ranges::any_of(
        attributes, [](const ExportedAttribute& one) { return one.name == "groom_color" && one.perPoint; });
    UsdMaterials made;
    NameGiver names(isLegalInUsd);
    std::map<std::size_t, std::size_t> known;  // of layers; the groom's own beyond them
    for (const PreparedPart& part : strands.parts) {
        const bool own = part.layer < groom.layers.size() && groom.layers[part.layer].material.has_value();
        const std::size_t layer = own ? part.layer : groom.layers.size();
        const auto [found, isNew] = known.emplace(layer, made.all.size());
        if (isNew)
            made.all.push_back(materialOf(folder, names.give(own ? groom.layers[layer].name : "hair"),
                                          groom.materialOf(part.layer), hasColours));
        made.ofPart.push_back(found->second);
    }
    return made;
}

UsdScalp usdScalp(const Groom& groom, const StrandExportOptions& options) {
    UsdScalp made;
    if (!groom.scalp || options.frames) return made;
    const ScalpMesh& head = *groom.scalp;
    std::map<std::uint32_t, std::int32_t> known;
    StrandExportOptions turned = options;
    turned.metresPerUnit = 1;
    for (const std::uint32_t triangle : groom.scalpSelection) {
        if (triangle >= head.triangleCount()) continue;
        made.faceVertexCounts.push_back(3);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = head.triangles()[triangle][corner];
            const auto [found, isNew] = known.emplace(vertex, static_cast<std::int32_t>(made.points.size()));
            if (isNew) {
                made.points.push_back(toFile(head.positions()[vertex], options));
                made.normals.push_back(toFile(head.normals()[vertex], turned));
            }
            made.faceVertexIndices.push_back(found->second);
            if (head.cornerUvs().empty()) continue;
            const Vec2f& uv = head.cornerUvs()[3 * std::size_t{triangle} + corner];
            made.uvs.insert(made.uvs.end(), {uv.x(), uv.y()});
        }
    }
    return made;
}

std::vector<std::pair<std::string, std::string>> usdSettings(const Groom& groom,
                                                             const PreparedStrands& strands,
                                                             bool hasOperators) {
    Groom settings = groom;
    if (!hasOperators) settings.operators.clear();
    std::vector<std::pair<std::string, std::string>> made{
        {std::string(kUsdSettings), settingsText(settings)}};
    if (hasOperators)
        made.emplace_back(kUsdShape, fmt::format("{}", hashOf(std::span<const Vec3f>(strands.positions))));
    return made;
}

bool usdHasOperators(const Groom& groom, const StrandExportOptions& options) {
    return !groom.operators.empty() && options.metresPerUnit == 1 && options.up == UpAxis::Y &&
           options.pointsPerStrand == 0 && !options.frames;
}

}  // namespace hairloom
