// SPDX-License-Identifier: GPL-3.0-or-later
// Cards, shells and strands as USD's text: a mesh or curves for each level with a UsdPreviewSurface, whose
// textures go beside the file. All levels are items of UsdLod, by distance. The variant set "lod" shows one
// of them to programs that do not know UsdLod (LOD0, the nearest, where nothing is chosen), and leaves all to
// those that do
// ("UsdLod"). The same chain gives the same bytes.
#include <fmt/format.h>

#include <algorithm>

#include "exporters/card_files.h"
#include "exporters/usd_curves.h"
#include "exporters/usda_numbers.h"

namespace hairloom {
namespace {

using cards::Level;
using cards::LevelArrays;

std::span<const float> numbersOfUvs(const std::vector<Vec2f>& values) {
    return {values[0].data(), values.size() * 2};
}

void writeVertexArray(std::string& out, const std::string& name, std::span<const float> numbers,
                      std::size_t components) {
    out += fmt::format("                {} = ", name);
    writeNumbers(out, numbers, components);
    out += " (\n                    interpolation = \"vertex\"\n                )\n";
}

/// Hairs of a level of strands, which have the colour and the width of each of their points.
std::string curvesText(const std::string& name, const cards::Hair& hair) {
    std::vector<float> widths;
    widths.reserve(hair.radii.size());
    for (const float radius : hair.radii) widths.push_back(2 * radius);
    const Vec3f half = Vec3f::Constant(*std::ranges::max_element(hair.radii));
    std::array<Vec3f, 2> extent = extentOf(hair.positions_ws);
    extent[0] -= half;
    extent[1] += half;
    std::vector<std::int32_t> counts;
    for (std::size_t s = 0; s < hair.strandCount(); ++s)
        counts.push_back(static_cast<std::int32_t>(hair.offsets[s + 1] - hair.offsets[s]));
    std::string out = fmt::format(
        "            def BasisCurves \"{0}\" (\n                prepend apiSchemas = "
        "[\"MaterialBindingAPI\"]\n"
        "            )\n            {{\n                rel material:binding = </hair/materials/{0}>\n"
        "                uniform token type = \"linear\"\n                uniform token wrap = "
        "\"nonperiodic\"\n                float3[] extent = ",
        name);
    writeNumbers(out, numbersOf(extent), 3);
    out += "\n                int[] curveVertexCounts = ";
    writeNumbers(out, std::span<const std::int32_t>(counts), 1);
    out += "\n                point3f[] points = ";
    writeNumbers(out, numbersOf(hair.positions_ws), 3);
    out += '\n';
    writeVertexArray(out, "float[] widths", widths, 1);
    writeVertexArray(out, "color3f[] primvars:displayColor", numbersOf(hair.albedo), 3);
    return out + "            }\n";
}

std::string meshText(const std::string& name, const LevelArrays& arrays) {
    std::string out = fmt::format(
        "            def Mesh \"{0}\" (\n                prepend apiSchemas = [\"MaterialBindingAPI\"]\n"
        "            )\n            {{\n                rel material:binding = </hair/materials/{0}>\n"
        "                uniform token subdivisionScheme = \"none\"\n"
        "                uniform bool doubleSided = true\n                float3[] extent = ",
        name);
    const std::array<Vec3f, 2> extent = extentOf(arrays.positions_ws);
    writeNumbers(out, numbersOf(extent), 3);
    const std::vector<std::int32_t> counts(arrays.indices.size() / 3, 3);
    out += "\n                int[] faceVertexCounts = ";
    writeNumbers(out, std::span<const std::int32_t>(counts), 1);
    out += "\n                int[] faceVertexIndices = ";
    writeNumbers(out, std::span<const std::uint32_t>(arrays.indices), 1);
    out += "\n                point3f[] points = ";
    writeNumbers(out, numbersOf(arrays.positions_ws), 3);
    out += '\n';
    writeVertexArray(out, "normal3f[] normals", numbersOf(arrays.normals_ws), 3);
    writeVertexArray(out, "color3f[] primvars:displayColor", numbersOf(arrays.colours), 3);
    if (!arrays.uvs.empty()) {
        std::vector<Vec2f> uvs = arrays.uvs;
        for (Vec2f& uv : uvs) uv.y() = 1 - uv.y();  // v goes up
        writeVertexArray(out, "texCoord2f[] primvars:st", numbersOfUvs(uvs), 2);
    }
    out += "            }\n";
    return out;
}

/// A shader that reads what meshes have at their vertices.
std::string readerText(std::string_view name, std::string_view type, std::string_view primvar) {
    return fmt::format(
        "            def Shader \"{}\"\n            {{\n"
        "                uniform token info:id = \"UsdPrimvarReader_{}\"\n"
        "                string inputs:varname = \"{}\"\n                {} outputs:result\n            }}\n",
        name, type, primvar, type);
}

std::string textureText(const std::string& material, std::string_view name, const std::string& file,
                        std::string_view more) {
    return fmt::format(
        "            def Shader \"{1}\"\n            {{\n                uniform token info:id = "
        "\"UsdUVTexture\"\n"
        "                asset inputs:file = @./{2}@\n"
        "                float2 inputs:st.connect = </hair/materials/{0}/st.outputs:result>\n{3}"
        "                float3 outputs:rgb\n                float outputs:a\n            }}\n",
        material, name, file, more);
}

std::string materialText(const std::string& name, const Level& level, const cards::TextureFiles& textures) {
    const auto* made = std::get_if<cards::Cards>(&level.content);
    std::string surface, readers;
    const auto connect = [&](std::string_view input, std::string_view output) {
        surface += fmt::format("                {}.connect = </hair/materials/{}/{}>\n", input, name, output);
    };
    if (made != nullptr) {
        connect("color3f inputs:diffuseColor", "colour.outputs:rgb");
        connect("float inputs:opacity", "colour.outputs:a");
        surface += fmt::format("                float inputs:opacityThreshold = {}\n", made->atlas.threshold);
        connect("normal3f inputs:normal", "normal.outputs:rgb");
        readers = readerText("st", "float2", "st") +
                  textureText(name, "colour", textures.colour,
                              "                token inputs:sourceColorSpace = \"sRGB\"\n") +
                  textureText(name, "normal", textures.normal,
                              "                token inputs:sourceColorSpace = \"raw\"\n"
                              "                float4 inputs:scale = (2, 2, 2, 1)\n"
                              "                float4 inputs:bias = (-1, -1, -1, 0)\n");
    } else {
        connect("color3f inputs:diffuseColor", "colour.outputs:result");
        readers = readerText("colour", "float3", "displayColor");
    }
    return fmt::format(
        "        def Material \"{0}\"\n        {{\n"
        "            token outputs:surface.connect = </hair/materials/{0}/surface.outputs:surface>\n\n"
        "            def Shader \"surface\"\n            {{\n"
        "                uniform token info:id = \"UsdPreviewSurface\"\n"
        "                float inputs:roughness = 0.5\n{1}                token outputs:surface\n"
        "            }}\n{2}        }}\n",
        name, surface, readers);
}

/// One variant for each level, in which the others are not there, and one in which all are.
std::string variantsText(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t lod = 0; lod < names.size(); ++lod) {
        text += fmt::format(
            "        \"LOD{}\" (\n            prepend apiSchemas = [\"LODOverrideAPI\"]\n        ) {{\n"
            "            token lod:override:mode = \"indexedLOD\"\n            float lod:override:index = "
            "0\n\n"
            "            over \"levels\"\n            {{\n",
            lod);
        for (const std::string& name : names) {
            if (name != names[lod])
                text += fmt::format(
                    "                over \"{}\" (\n                    active = false\n"
                    "                )\n                {{\n                }}\n",
                    name);
        }
        text += "            }\n        }\n";
    }
    return text + "        \"UsdLod\" {\n        }\n";
}

/// What says which level is seen from how far.
std::string heuristicText(std::span<const Vec3f> nearest, std::span<const float> distances) {
    const std::array<Vec3f, 2> extent = extentOf(nearest);
    const Vec3f centre = 0.5f * (extent[0] + extent[1]);
    std::string text = fmt::format(
        "    def LODDistanceHeuristic \"distance\"\n    {{\n        uniform token lod:domain = \"imaging\"\n"
        "        point3f center = ({}, {}, {})\n        uniform float[] thresholds = ",
        centre.x(), centre.y(), centre.z());
    writeNumbers(text, distances, 1);
    return text + "\n    }\n";
}

Result<WrittenCards> writeCardUsd(const CardsToWrite& hair, const std::filesystem::path& path) {
    std::string shapes, materials;
    CardFiles files(1);
    std::vector<std::string> levels;
    std::vector<float> distances;  ///< from which on each level but the first is seen
    std::vector<Vec3f> nearest;
    NameGiver names(isLegalInUsd);
    for (const Level& level : hair.chain.levels) {
        const std::string name = names.give(level.name);
        cards::TextureFiles textures;
        const std::vector<Vec3f>* positions = nullptr;
        LevelArrays arrays;
        if (const auto* strands = std::get_if<cards::Hair>(&level.content)) {
            positions = &strands->positions_ws;
            shapes += curvesText(name, *strands);
        } else {
            arrays = cards::arraysOf(level, hair.chain.rig);
            auto made = cards::textureFilesOf(level, arrays, path.stem().string(), hair.cancelled);
            if (!made) return tl::unexpected(made.error());
            textures = std::move(*made);
            positions = &arrays.positions_ws;
            shapes += meshText(name, arrays);
        }
        if (levels.empty())
            nearest = *positions;
        else
            distances.push_back(static_cast<float>(cards::distanceOf(level.spec.headPx)));
        levels.push_back(name);
        materials += materialText(name, level, textures);
        for (auto& [beside, bytes] : textures.files)
            files.emplace_back(path.parent_path() / beside, std::move(bytes));
    }
    if (levels.empty()) return fail("there are no levels", "one of strands, cards or a shell");
    const std::string text = fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"hair\"\n    doc = \"Hairloom\"\n    metersPerUnit = 1\n"
        "    upAxis = \"Y\"\n)\n\ndef Xform \"hair\" (\n    variants = {{\n        string lod = \"LOD0\"\n"
        "    }}\n    prepend variantSets = \"lod\"\n)\n{{\n"
        "    def Xform \"levels\" (\n        prepend apiSchemas = [\"LODRootAPI\"]\n    )\n    {{\n"
        "        int lod:default:index = 0\n        rel lod:heuristics = </hair/distance>\n\n{}    }}\n\n{}\n"
        "    def Scope \"materials\"\n    {{\n{}    }}\n"
        "    variantSet \"lod\" = {{\n{}    }}\n}}\n",
        shapes, heuristicText(nearest, distances), materials, variantsText(levels));
    const auto bytes = std::as_bytes(std::span(text));
    files.front() = {path, {bytes.begin(), bytes.end()}};
    auto companions = writeTogether(files);
    if (!companions) return tl::unexpected(companions.error());
    return WrittenCards{std::move(*companions),
                        {springsLeftBehind(),
                         jointsLeftBehind(),
                         {"differences between cards that share a texture",
                          "multiply displayColor in yourself, because UsdPreviewSurface cannot"}}};
}

constexpr const char* kName = "usda-cards";

}  // namespace

bool holdsStrandLevels(const HairWriter& writer) {
    return writer.name == kName;
}

HairWriter usdaCardsWriter() {
    return cardWriter(kName, "Cards as USD .usda",
                      "levels by distance (UsdLod) and as variants, with textures next to the file",
                      {"cards-usd", "Engines without strands: cards (USD)", "", {}}, "usda", writeCardUsd);
}

}  // namespace hairloom
