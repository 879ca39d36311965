// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/mesh_writer/assimp_cards.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <cstring>
#include <iterator>
#include <memory>
#include <string_view>

namespace hairloom {
namespace {

aiVector3D vectorOf(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

aiMatrix4x4 matrixOf(const Eigen::Affine3f& place) {
    aiMatrix4x4 matrix;
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 4; ++column) matrix[row][column] = place(row, column);
    return matrix;
}

/// Where a joint is at rest, in the file's unit.
Eigen::Affine3f placeOf(const CardJoint& joint, float scale) {
    Eigen::Affine3f place = Eigen::Affine3f::Identity();
    place.linear() << joint.x_ws, joint.y_ws, joint.z_ws;
    place.translation() = scale * joint.position_ws;
    return place;
}

/// assimp deletes arrays with delete[].
template <class T>
T* arrayOf(const std::vector<T>& values) {
    T* const array = new T[values.size()];
    std::ranges::copy(values, array);
    return array;
}

std::vector<aiBone*> bonesOf(const CardMesh& mesh, const std::vector<CardJoint>& joints, float scale) {
    std::vector<std::vector<aiVertexWeight>> held(joints.size());
    for (unsigned v = 0; v < mesh.weights.size(); ++v) {
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = mesh.weights[v][k];
            if (weight > 0) held[mesh.joints[v][k]].emplace_back(v, weight);
        }
    }
    std::vector<aiBone*> bones;
    for (std::size_t j = 0; j < held.size(); ++j) {
        if (held[j].empty()) continue;
        auto* bone = new aiBone;
        bone->mName = joints[j].name;
        bone->mNumWeights = static_cast<unsigned>(held[j].size());
        bone->mWeights = arrayOf(held[j]);
        bone->mOffsetMatrix = matrixOf(placeOf(joints[j], scale).inverse());
        bones.push_back(bone);
    }
    return bones;
}

/// Positions times `scale`; bones where there are joints.
aiMesh* meshOf(const CardMesh& card, unsigned material, float scale, const std::vector<CardJoint>* joints) {
    auto* mesh = new aiMesh;
    mesh->mName = card.name;
    mesh->mMaterialIndex = material;
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = static_cast<unsigned>(card.positions_ws.size());
    std::vector<aiVector3D> positions, normals, uvs;
    std::vector<aiColor4D> colours;
    for (std::size_t v = 0; v < card.positions_ws.size(); ++v) {
        positions.push_back(vectorOf(scale * card.positions_ws[v]));
        normals.push_back(vectorOf(card.normals_ws[v]));
        const Vec3f& colour = card.colours[v];
        colours.emplace_back(colour.x(), colour.y(), colour.z(), 1.0f);
        // v goes up in both formats.
        if (!card.uvs.empty()) uvs.emplace_back(card.uvs[v].x(), 1 - card.uvs[v].y(), 0.0f);
    }
    mesh->mVertices = arrayOf(positions);
    mesh->mNormals = arrayOf(normals);
    mesh->mColors[0] = arrayOf(colours);
    if (!uvs.empty()) mesh->mTextureCoords[0] = arrayOf(uvs), mesh->mNumUVComponents[0] = 2;
    mesh->mNumFaces = static_cast<unsigned>(card.indices.size() / 3);
    mesh->mFaces = new aiFace[mesh->mNumFaces];
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
        mesh->mFaces[f].mNumIndices = 3;
        mesh->mFaces[f].mIndices = new unsigned[3];
        std::copy_n(card.indices.begin() + std::ptrdiff_t{3} * f, 3, mesh->mFaces[f].mIndices);
    }
    if (joints == nullptr) return mesh;
    const auto bones = bonesOf(card, *joints, scale);
    mesh->mNumBones = static_cast<unsigned>(bones.size());
    mesh->mBones = arrayOf(bones);
    return mesh;
}

aiMaterial* materialOf(const CardMesh& card) {
    auto* material = new aiMaterial;
    const aiString name(card.material);
    material->AddProperty(&name, AI_MATKEY_NAME);
    const aiColor3D white(1, 1, 1);
    material->AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
    const int twoSided = 1;
    material->AddProperty(&twoSided, 1, AI_MATKEY_TWOSIDED);
    if (card.colourFile.empty()) return material;
    const aiString colourFile(card.colourFile), normalFile(card.normalFile);
    material->AddProperty(&colourFile, AI_MATKEY_TEXTURE_DIFFUSE(0));
    material->AddProperty(&colourFile, AI_MATKEY_TEXTURE_OPACITY(0));
    material->AddProperty(&normalFile, AI_MATKEY_TEXTURE_NORMALS(0));
    return material;
}

void setChildren(aiNode& node, const std::vector<aiNode*>& children) {
    node.mNumChildren = static_cast<unsigned>(children.size());
    node.mChildren = arrayOf(children);
    for (aiNode* child : children) child->mParent = &node;
}

/// Those that hang on no other.
std::vector<aiNode*> jointNodes(const std::vector<CardJoint>& joints, float scale) {
    std::vector<aiNode*> nodes, roots;
    std::vector<std::vector<aiNode*>> children(joints.size());
    for (const CardJoint& joint : joints) {
        nodes.push_back(new aiNode(joint.name));
        Eigen::Affine3f place = placeOf(joint, scale);
        if (joint.parent >= 0) {
            const auto parent = static_cast<std::size_t>(joint.parent);
            place = placeOf(joints[parent], scale).inverse() * place;
            children[parent].push_back(nodes.back());
        } else {
            roots.push_back(nodes.back());
        }
        nodes.back()->mTransformation = matrixOf(place);
    }
    for (std::size_t j = 0; j < nodes.size(); ++j)
        if (!children[j].empty()) setChildren(*nodes[j], children[j]);
    return roots;
}

std::unique_ptr<aiScene> sceneOf(const CardMeshScene& cards) {
    const bool isFbx = cards.format == CardMeshFormat::fbx;
    const float scale = isFbx ? 100.0f : 1.0f;
    std::vector<aiMesh*> meshes;
    std::vector<aiMaterial*> materials;
    std::vector<aiNode*> nodes;
    for (const CardMesh& card : cards.meshes) {
        const auto index = static_cast<unsigned>(meshes.size());
        meshes.push_back(meshOf(card, index, scale, isFbx ? &cards.joints : nullptr));
        materials.push_back(materialOf(card));
        nodes.push_back(new aiNode(card.name));
        nodes.back()->mNumMeshes = 1;
        nodes.back()->mMeshes = new unsigned[1]{index};
    }
    if (isFbx) std::ranges::copy(jointNodes(cards.joints, scale), std::back_inserter(nodes));
    auto scene = std::make_unique<aiScene>();
    scene->mNumMeshes = static_cast<unsigned>(meshes.size());
    scene->mMeshes = arrayOf(meshes);
    scene->mNumMaterials = static_cast<unsigned>(materials.size());
    scene->mMaterials = arrayOf(materials);
    // Not a name that a joint has.
    scene->mRootNode = new aiNode("scene");
    setChildren(*scene->mRootNode, nodes);
    return scene;
}

/// Binary FBX of assimp, mended: it leaves out the 25 zeros that end lists of nodes, over which readers
/// stumble, its own among them, and puts in the time of writing, so that no two files are alike.
class MendedFbx {
  public:
    explicit MendedFbx(std::string fbx) : in_(std::move(fbx)) {
        constexpr std::size_t kBeforeNodes = 27;
        std::size_t at = std::min(kBeforeNodes, in_.size());
        out_.assign(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(at));
        while (at + kEnd <= in_.size() && number(at) != 0) at = copyNode(at);
        out_.insert(out_.end(), in_.begin() + static_cast<std::ptrdiff_t>(at), in_.end());
    }
    std::string take() { return std::move(out_); }

  private:
    static constexpr std::size_t kEnd = 25;  ///< bytes of what ends a list; of a node before its name

    std::uint64_t number(std::size_t at) const {
        std::uint64_t value = 0;
        std::memcpy(&value, in_.data() + at, sizeof(value));
        return value;
    }
    /// Of what assimp has just written: it is trusted. Where the node ends.
    std::size_t copyNode(std::size_t at) {
        const std::size_t end = number(at), properties = number(at + 16);
        const std::size_t nameLength = static_cast<unsigned char>(in_[at + 24]);
        const std::string_view name(in_.data() + at + kEnd, nameLength);
        if (name == "CreationTimeStamp") return end;
        const std::size_t start = out_.size();
        std::size_t child = at + kEnd + nameLength + properties;
        out_.insert(out_.end(), in_.begin() + static_cast<std::ptrdiff_t>(at),
                    in_.begin() + static_cast<std::ptrdiff_t>(child));
        if (child < end) {
            while (child < end && number(child) != 0) child = copyNode(child);
            out_.resize(out_.size() + kEnd);
        }
        const std::uint64_t newEnd = out_.size();
        std::memcpy(out_.data() + start, &newEnd, sizeof(newEnd));
        return end;
    }
    std::string in_, out_;
};

}  // namespace

Result<std::vector<WrittenMeshFile>> meshFilesOf(const CardMeshScene& cards) {
    const bool isFbx = cards.format == CardMeshFormat::fbx;
    const auto scene = sceneOf(cards);
    Assimp::Exporter exporter;
    Assimp::ExportProperties properties;
    properties.SetPropertyString(AI_CONFIG_EXPORT_BLOB_NAME, cards.stem);
    const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), isFbx ? "fbx" : "obj", 0u, &properties);
    if (blob == nullptr)
        return fail(fmt::format("assimp: {}", exporter.GetErrorString()), "cards that it can write");
    std::vector<WrittenMeshFile> files;
    for (; blob != nullptr; blob = blob->next) {
        std::string bytes(static_cast<const char*>(blob->data), blob->size);
        if (isFbx) bytes = MendedFbx(std::move(bytes)).take();
        files.push_back({blob->name.C_Str(), std::move(bytes)});
    }
    return files;
}

}  // namespace hairloom
