// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The names that a project file gives to its arrays; shared by saving and loading.

#include <string_view>

namespace hairloom::section {

inline constexpr std::string_view kKind = "project";
inline constexpr std::string_view kOffsets = "offsets";
inline constexpr std::string_view kStrandPrefix = "strand/";  ///< followed by the attribute's name
inline constexpr std::string_view kPointPrefix = "point/";    ///< followed by the attribute's name
inline constexpr std::string_view kSelection = "scalp_selection";
inline constexpr std::string_view kRootTriangles = "triangulation/triangles";  ///< 3 strands each
inline constexpr std::string_view kCoincident = "triangulation/coincident";    ///< root, sameAs
inline constexpr std::string_view kAlone = "triangulation/alone";              ///< roots without a triangle
inline constexpr std::string_view kScalpPositions = "scalp/positions";
inline constexpr std::string_view kScalpNormals = "scalp/normals";
inline constexpr std::string_view kScalpTriangles = "scalp/triangles";  ///< 3 vertices each
inline constexpr std::string_view kScalpCornerUvs = "scalp/corner_uvs";
inline constexpr std::string_view kScalpSourceFaces = "scalp/source_faces";
inline constexpr std::string_view kScalpSourceVertices = "scalp/source_vertices";
inline constexpr std::string_view kScalpGroups = "scalp/triangle_groups";
inline constexpr std::string_view kScalpDensity = "scalp/density";  ///< per vertex, or none
inline constexpr std::string_view kScalpMaterials = "scalp/triangle_materials";
inline constexpr std::string_view kBody = "body";  ///< bytes of runtime::BodyField

}  // namespace hairloom::section
