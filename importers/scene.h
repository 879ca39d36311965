// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Characters from mesh files: OBJ, PLY, STL, FBX, glTF, GLB, USD and Alembic. docs/formats/meshes.md says
// what is read of each.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/animation/clip.h"
#include "core/animation/skinning.h"
#include "core/geometry/scalp_mesh.h"

namespace hairloom {

struct MeshImportOptions {
    /// Metres in one unit of a file that states none (OBJ, PLY, STL, Alembic), > 0; where this is empty,
    /// metres, and centimetres in USD. Files that state their unit (FBX, glTF, most of USD) keep it, with a
    /// warning.
    std::optional<float> metresPerUnit;
};

struct ImportedScene {
    ScalpMesh mesh;  ///< metres, Y up, at rest
    Skeleton skeleton;
    std::vector<Clip> clips;
    SkinWeights skin;                 ///< per vertex of `mesh`; empty when no bone moves it
    std::vector<MorphTarget> morphs;  ///< of `mesh`'s vertices; those that clips move
    std::vector<std::string> warnings;
    std::string format;       ///< "obj", "ply", "stl", "fbx", "gltf", "glb", "usd", "abc"
    float metresPerUnit = 1;  ///< that the file's lengths were multiplied with
    bool statesUnit = false;  ///< the file says it
    bool statesUp = false;    ///< the file says which axis is up
};

/// Reads a file by its content; its name plays no part. It is read in a process of its own
/// (hairloom-mesh-reader, found beside the running program or named by the environment variable
/// HAIRLOOM_MESH_READER), FBX, glTF and STL within meshLimits(), others within limitsOfFile(). Errors:
/// missing or unreadable file, no supported format, damaged or too large for these limits, no faces, nothing
/// left after repair, stopped (core/base/stop_scope.h).
Result<ImportedScene> importScene(const std::filesystem::path& path, const MeshImportOptions& options = {});

}  // namespace hairloom
