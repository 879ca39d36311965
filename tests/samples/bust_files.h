// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The committed bust as assimp reads it, welded by position.

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "tests/support/source_dir.h"

namespace hairloom::bust {

inline std::filesystem::path bustFolder() {
    return sourceDir() / "samples" / "bust";
}

struct BustFile {
    std::vector<Vec3d> positions;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::array<Vec2d, 3>> uvs;  ///< of the corners of each triangle
    std::vector<std::string> groups;        ///< name of the material of each triangle
};

inline BustFile weld(const aiScene& scene) {
    BustFile file;
    std::map<std::array<float, 3>, int> known;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        const std::string name = scene.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            std::array<int, 3> corners{};
            std::array<Vec2d, 3> uv;
            for (unsigned k = 0; k < 3; ++k) {
                const unsigned v = mesh.mFaces[f].mIndices[k];
                const aiVector3D p = mesh.mVertices[v];
                const auto [entry, fresh] =
                    known.try_emplace({p.x, p.y, p.z}, static_cast<int>(file.positions.size()));
                if (fresh) file.positions.emplace_back(p.x, p.y, p.z);
                corners[k] = entry->second;
                uv[k] = {mesh.mTextureCoords[0][v].x, mesh.mTextureCoords[0][v].y};
            }
            file.triangles.push_back(corners);
            file.uvs.push_back(uv);
            file.groups.push_back(name);
        }
    }
    return file;
}

/// Read without any repair; the importer owns the scene.
inline const aiScene* readBust(Assimp::Importer& importer, const char* name) {
    return importer.ReadFile((bustFolder() / name).string(), 0);
}

}  // namespace hairloom::bust
