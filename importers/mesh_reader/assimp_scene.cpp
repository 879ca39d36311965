// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/assimp_scene.h"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <string>
#include <unordered_map>

#include "importers/mesh_reader/assimp_skeleton.h"
#include "importers/mesh_reader/limited_files.h"
#include "importers/scene_parts.h"

namespace hairloom {
namespace {

/// Leaves the readers for one extension only, so that no file is taken for a format that is not meant.
void keepReadersOf(Assimp::Importer& importer, std::string_view extension) {
    for (std::size_t index = importer.GetImporterCount(); index-- > 0;) {
        const aiImporterDesc* description = importer.GetImporterInfo(index);
        std::string extensions = description ? description->mFileExtensions : "";
        std::ranges::transform(extensions, extensions.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if ((" " + extensions + " ").find(fmt::format(" {} ", extension)) == std::string::npos) {
            importer.UnregisterLoader(importer.GetImporter(index));
        }
    }
}

void configure(Assimp::Importer& importer) {
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
}

Error explain(std::string message, const std::string& alias, const char* file) {
    for (std::size_t at = message.find(alias); at != message.npos; at = message.find(alias)) {
        message.replace(at, alias.size(), file);
    }
    while (!message.empty() &&
           (std::isspace(static_cast<unsigned char>(message.back())) || message.back() == '.')) {
        message.pop_back();
    }
    Error error{{}, {}, message.empty() ? "cannot be read, without a reason from the reader" : message, {}};
    const std::size_t at = message.find("line ");
    if (at != message.npos && std::isdigit(static_cast<unsigned char>(message[at + 5]))) {
        error.place = Line{std::strtoull(message.c_str() + at + 5, nullptr, 10)};
    }
    return error;
}

/// Turns the axes that an FBX file states so that Y is up and X is right.
Eigen::Affine3f axesToWorld(const aiMetadata& settings, std::vector<std::string>& warnings) {
    Mat3f rotation = Mat3f::Zero();
    constexpr std::array<const char*, 3> kNames{"CoordAxis", "UpAxis", "FrontAxis"};
    for (int row = 0; row < 3; ++row) {
        std::int32_t axis = row, sign = 1;
        settings.Get(kNames[static_cast<std::size_t>(row)], axis);
        settings.Get(fmt::format("{}Sign", kNames[static_cast<std::size_t>(row)]), sign);
        if (axis >= 0 && axis < 3) rotation(row, axis) = sign < 0 ? -1.0f : 1.0f;
    }
    if (std::abs(rotation.determinant() - 1) > 1e-3f) {
        warnings.push_back("the file's axes are not right-handed, so Y is taken as up");
        rotation.setIdentity();
    }
    return Eigen::Affine3f(rotation);
}

class Converter {
  public:
    Converter(const aiScene& source, MeshFormat format)
        : source_(source), format_(format), morphs_(source, scene_) {}

    RawScene convert() {
        Eigen::Affine3f toWorld = Eigen::Affine3f::Identity();
        const bool isGltf = format_ == MeshFormat::Gltf || format_ == MeshFormat::Glb;
        if (isGltf) scene_.metresPerUnit = 1;
        scene_.statesUp = format_ != MeshFormat::Stl;
        if (format_ == MeshFormat::Fbx && source_.mMetaData) {
            float centimetres = 1;
            source_.mMetaData->Get("UnitScaleFactor", centimetres);
            if (std::isfinite(centimetres) && centimetres > 0) scene_.metresPerUnit = centimetres * 0.01f;
            toWorld = axesToWorld(*source_.mMetaData, scene_.warnings);
        }
        for (unsigned mesh = 0; mesh < source_.mNumMeshes; ++mesh) {
            anyUvs_ = anyUvs_ || source_.mMeshes[mesh]->HasTextureCoords(0);
            allNormals_ = allNormals_ && source_.mMeshes[mesh]->HasNormals();
        }
        SkeletonBuilder skeleton(source_, toWorld, isGltf, morphs_, scene_);
        addNodes(skeleton);
        skeleton.addClips(morphs_);
        morphs_.finish();
        finish();
        return std::move(scene_);
    }

  private:
    bool hasMaterials() const { return format_ != MeshFormat::Stl; }

    /// Materials in the order of their first use; several of one name are one.
    std::uint32_t materialOf(const aiMesh& mesh) {
        std::string name = "default";
        if (mesh.mMaterialIndex < source_.mNumMaterials)
            name = source_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
        if (name.empty()) name = fmt::format("material {}", mesh.mMaterialIndex);
        return indexOf(name, materials_, scene_.soup.materialNames);
    }

    /// Depth first, children in the file's order.
    void addNodes(SkeletonBuilder& skeleton) {
        std::vector<const aiNode*> waiting{source_.mRootNode};
        while (!waiting.empty()) {
            const aiNode* node = waiting.back();
            waiting.pop_back();
            for (unsigned index = 0; index < node->mNumMeshes; ++index) {
                addMesh(*source_.mMeshes[node->mMeshes[index]], *node, skeleton);
            }
            for (unsigned child = node->mNumChildren; child-- > 0;) waiting.push_back(node->mChildren[child]);
        }
    }

    std::uint32_t groupOf(const aiMesh& mesh, const aiNode& node) {
        std::string name = hasMaterials() ? node.mName.C_Str() : mesh.mName.C_Str();
        if (name.empty() || name.front() == '<') name = "default";
        return indexOf(name, groups_, scene_.soup.groupNames);
    }

    void addMesh(const aiMesh& mesh, const aiNode& node, SkeletonBuilder& skeleton) {
        PolygonSoup& soup = scene_.soup;
        const Eigen::Affine3f toWorld = skeleton.meshToWorld(mesh, node);
        const auto firstVertex = static_cast<std::uint32_t>(soup.positions.size());
        for (unsigned vertex = 0; vertex < mesh.mNumVertices; ++vertex) {
            const aiVector3D& p = mesh.mVertices[vertex];
            soup.positions.push_back(toWorld * Vec3f(p.x, p.y, p.z));
        }
        morphs_.add(mesh, node, firstVertex, toWorld.linear());
        const std::uint32_t group = groupOf(mesh, node);
        const std::uint32_t material = hasMaterials() ? materialOf(mesh) : 0;
        const Mat3f normalMatrix = cofactors(toWorld.linear());
        const bool mirrored = toWorld.linear().determinant() < 0;
        for (unsigned index = 0; index < mesh.mNumFaces; ++index) {
            const aiFace& face = mesh.mFaces[index];
            if (face.mNumIndices < 3) {
                ++leftOut_;
                continue;
            }
            for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
                const unsigned vertex = face.mIndices[mirrored ? face.mNumIndices - 1 - corner : corner];
                addCorner(mesh, vertex, firstVertex, normalMatrix, mirrored);
            }
            soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            soup.faceGroups.push_back(group);
            if (hasMaterials()) soup.faceMaterials.push_back(material);
        }
        skeleton.addWeights(mesh, node, toWorld);
    }

    static Mat3f cofactors(const Mat3f& m) {
        Mat3f result;
        result << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
        return result;
    }

    void addCorner(const aiMesh& mesh, unsigned vertex, std::uint32_t firstVertex, const Mat3f& normalMatrix,
                   bool mirrored) {
        PolygonSoup& soup = scene_.soup;
        const bool exists = vertex < mesh.mNumVertices;
        // An index that names nothing is kept as one, for the check that tells of it.
        soup.corners.push_back(exists ? firstVertex + vertex : 0xffffffffu);
        if (anyUvs_) {
            Vec2f uv = Vec2f::Zero();
            if (exists && mesh.HasTextureCoords(0)) {
                uv = Vec2f(mesh.mTextureCoords[0][vertex].x, mesh.mTextureCoords[0][vertex].y);
            }
            soup.uvs.push_back(uv.allFinite() ? uv : Vec2f::Zero());
        }
        if (allNormals_) {
            Vec3f normal = Vec3f::Zero();
            if (exists) {
                const aiVector3D& n = mesh.mNormals[vertex];
                normal = normalMatrix * Vec3f(n.x, n.y, n.z) * (mirrored ? -1.0f : 1.0f);
            }
            const float length = normal.norm();
            badNormals_ += !(std::isfinite(length) && length > 0);
            soup.normals.push_back(normal / length);
        }
    }

    void finish() {
        PolygonSoup& soup = scene_.soup;
        if (leftOut_ != 0)
            scene_.warnings.push_back(fmt::format("{} points and lines were left out", leftOut_));
        if (badNormals_ != 0) {
            scene_.warnings.push_back(
                fmt::format("{} normals are unusable, so all are computed from the faces", badNormals_));
        }
        if (badNormals_ != 0 || !allNormals_) soup.normals.clear();
        if (scene_.bones.empty()) scene_.skin = {};
    }

    const aiScene& source_;
    MeshFormat format_;
    RawScene scene_;
    AssimpMorphs morphs_;
    std::unordered_map<std::string, std::uint32_t> groups_, materials_;
    bool anyUvs_ = false;
    bool allNormals_ = true;
    std::size_t leftOut_ = 0;
    std::size_t badNormals_ = 0;
};

}  // namespace

Result<RawScene> readWithAssimp(const char* file, MeshFormat format) {
    Assimp::Importer importer;
    const std::string extension(name(format));
    keepReadersOf(importer, extension);
    configure(importer);
    auto* files = new LimitedFiles(file, extension);  // the importer deletes it
    importer.SetIOHandler(files);
    const std::string alias = files->alias();
    const aiScene* scene = importer.ReadFile(alias, 0);
    if (!scene || !scene->mRootNode) return tl::unexpected(explain(importer.GetErrorString(), alias, file));
    return Converter(*scene, format).convert();
}

}  // namespace hairloom
