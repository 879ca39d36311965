// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What stands beside the curves of a USD file: materials that renderers and viewers know, and the scalp.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exporters/exported_attributes.h"
#include "exporters/exported_parts.h"

namespace hairloom {

/// An input of a shader: numbers, a text (of tokens and strings), or the output that it is connected to.
struct UsdShaderInput {
    std::string type, name;  ///< "color3f", "diffuseColor"
    std::vector<float> numbers;
    std::string text, connection;
};
struct UsdShader {
    std::string name, id;
    std::vector<UsdShaderInput> inputs;
    std::vector<std::pair<std::string, std::string>> outputs;  ///< type and name
};
/// Names that stand beside the parts' and are none of these.
struct UsdBeside {
    std::string scalp, materials, physics;
};
UsdBeside usdBeside(std::span<const ExportedPart> parts);

/// A prim below the materials.
struct UsdMaterial {
    std::string name, path;
    std::vector<UsdShader> shaders;
    std::string preview, surface;  ///< paths of outputs: for viewers, and of MaterialX
};

struct UsdMaterials {
    std::vector<UsdMaterial> all;
    std::vector<std::size_t> ofPart;  ///< index into all
};
/// Below /groom/FOLDER: one for all parts whose layers have none of their own: UsdPreviewSurface, and
/// Chiang's hair of MaterialX 1.39 with the pigment or the colour of ours.
UsdMaterials usdMaterials(const Groom& groom, const PreparedStrands& strands,
                          std::span<const ExportedAttribute> attributes, const std::string& folder);

/// The faces that hair grows on, in the file's unit and axes; empty without a head, and where hair moves.
struct UsdScalp {
    std::vector<Vec3f> points, normals;  ///< of a corner's vertex
    std::vector<std::int32_t> faceVertexCounts, faceVertexIndices;
    std::vector<float> uvs;  ///< two of each corner; empty without UVs
    bool empty() const { return points.empty(); }
};
UsdScalp usdScalp(const Groom& groom, const StrandExportOptions& options);

/// What the prim of the groom has of the project's settings: name and text (importers/authored_settings.h).
std::vector<std::pair<std::string, std::string>> usdSettings(const Groom& groom,
                                                             const PreparedStrands& strands,
                                                             bool hasOperators);

/// Whether a file of these strands and options can have operators: their points as they are in the project.
bool usdHasOperators(const Groom& groom, const StrandExportOptions& options);

}  // namespace hairloom
