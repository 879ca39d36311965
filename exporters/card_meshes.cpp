// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_meshes.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <cstring>
#include <iterator>
#include <memory>
#include <string_view>

#include "core/cards/level_arrays.h"

namespace hairloom {
namespace {

using cards::Level;
using cards::LevelArrays;
using cards::Rig;

aiVector3D vectorOf(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

aiMatrix4x4 moved(const Vec3f& by) {
    aiMatrix4x4 matrix;
    aiMatrix4x4::Translation(vectorOf(by), matrix);
    return matrix;
}

/// assimp deletes arrays with delete[].
template <class T>
T* arrayOf(const std::vector<T>& values) {
    T* const array = new T[values.size()];
    std::ranges::copy(values, array);
    return array;
}

std::string jointName(const Rig& rig, std::size_t joint) {
    if (joint == 0) return "head";
    return fmt::format("hair_{}_{}", (joint - 1) / rig.perChain, (joint - 1) % rig.perChain);
}

std::vector<aiBone*> bonesOf(const LevelArrays& arrays, const Rig& rig, float scale) {
    std::vector<std::vector<aiVertexWeight>> held(rig.joints.size());
    for (unsigned v = 0; v < arrays.weights.size(); ++v) {
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = arrays.weights[v][static_cast<int>(k)];
            if (weight > 0) held[arrays.joints[v][k]].emplace_back(v, weight);
        }
    }
    std::vector<aiBone*> bones;
    for (std::size_t j = 0; j < held.size(); ++j) {
        if (held[j].empty()) continue;
        auto* bone = new aiBone;
        bone->mName = jointName(rig, j);
        bone->mNumWeights = static_cast<unsigned>(held[j].size());
        bone->mWeights = arrayOf(held[j]);
        bone->mOffsetMatrix = moved(-scale * rig.joints[j].position_ws);
        bones.push_back(bone);
    }
    return bones;
}

/// Positions times `scale`; joints where it has a rig.
aiMesh* meshOf(const std::string& name, const LevelArrays& arrays, unsigned material, float scale,
               const Rig* rig) {
    auto* mesh = new aiMesh;
    mesh->mName = name;
    mesh->mMaterialIndex = material;
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = static_cast<unsigned>(arrays.positions_ws.size());
    std::vector<aiVector3D> positions, normals, uvs;
    std::vector<aiColor4D> colours;
    for (std::size_t v = 0; v < arrays.positions_ws.size(); ++v) {
        positions.push_back(vectorOf(scale * arrays.positions_ws[v]));
        normals.push_back(vectorOf(arrays.normals_ws[v]));
        const Vec3f& colour = arrays.colours[v];
        colours.emplace_back(colour.x(), colour.y(), colour.z(), 1.0f);
        // v goes up in both formats.
        if (!arrays.uvs.empty()) uvs.emplace_back(arrays.uvs[v].x(), 1 - arrays.uvs[v].y(), 0.0f);
    }
    mesh->mVertices = arrayOf(positions);
    mesh->mNormals = arrayOf(normals);
    mesh->mColors[0] = arrayOf(colours);
    if (!uvs.empty()) mesh->mTextureCoords[0] = arrayOf(uvs), mesh->mNumUVComponents[0] = 2;
    mesh->mNumFaces = static_cast<unsigned>(arrays.indices.size() / 3);
    mesh->mFaces = new aiFace[mesh->mNumFaces];
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
        mesh->mFaces[f].mNumIndices = 3;
        mesh->mFaces[f].mIndices = new unsigned[3];
        std::copy_n(arrays.indices.begin() + std::ptrdiff_t{3} * f, 3, mesh->mFaces[f].mIndices);
    }
    if (rig == nullptr) return mesh;
    const auto bones = bonesOf(arrays, *rig, scale);
    mesh->mNumBones = static_cast<unsigned>(bones.size());
    mesh->mBones = arrayOf(bones);
    return mesh;
}

aiMaterial* materialOf(const Level& level, const std::string& colour, const std::string& normal) {
    auto* material = new aiMaterial;
    const aiString name(level.name);
    material->AddProperty(&name, AI_MATKEY_NAME);
    const aiColor3D white(1, 1, 1);
    material->AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
    const int twoSided = 1;
    material->AddProperty(&twoSided, 1, AI_MATKEY_TWOSIDED);
    if (colour.empty()) return material;
    const aiString colourFile(colour), normalFile(normal);
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

aiNode* jointNodes(const Rig& rig, float scale) {
    std::vector<aiNode*> nodes;
    std::vector<std::vector<aiNode*>> children(rig.joints.size());
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const cards::Joint& joint = rig.joints[j];
        nodes.push_back(new aiNode(jointName(rig, j)));
        Vec3f at = joint.position_ws;
        if (joint.parent >= 0) {
            at -= rig.joints[static_cast<std::size_t>(joint.parent)].position_ws;
            children[static_cast<std::size_t>(joint.parent)].push_back(nodes.back());
        }
        nodes.back()->mTransformation = moved(scale * at);
    }
    for (std::size_t j = 0; j < nodes.size(); ++j)
        if (!children[j].empty()) setChildren(*nodes[j], children[j]);
    return nodes[0];
}

struct Files {
    std::unique_ptr<aiScene> scene = std::make_unique<aiScene>();
    CardFiles textures;
};

Result<Files> filesOf(const cards::Chain& chain, CardMeshFormat format, const std::filesystem::path& path) {
    const bool isFbx = format == CardMeshFormat::fbx;
    const float scale = isFbx ? 100.0f : 1.0f;
    Files files;
    std::vector<aiMesh*> meshes;
    std::vector<aiMaterial*> materials;
    std::vector<aiNode*> nodes;
    for (const Level& level : chain.levels) {
        if (level.spec.kind == cards::LevelKind::strands) continue;
        const LevelArrays arrays = cards::arraysOf(level, chain.rig);
        auto textures = cards::textureFilesOf(level, arrays, path.stem().string());
        if (!textures) return tl::unexpected(textures.error());
        // Unity makes a group of levels of names that end so.
        const std::string name = fmt::format("{}_LOD{}", level.name, meshes.size());
        const auto index = static_cast<unsigned>(meshes.size());
        meshes.push_back(meshOf(name, arrays, index, scale, isFbx ? &chain.rig : nullptr));
        materials.push_back(materialOf(level, textures->colour, textures->normal));
        for (auto& [beside, bytes] : textures->files)
            files.textures.emplace_back(path.parent_path() / beside, std::move(bytes));
        nodes.push_back(new aiNode(name));
        nodes.back()->mNumMeshes = 1;
        nodes.back()->mMeshes = new unsigned[1]{index};
    }
    if (isFbx) nodes.push_back(jointNodes(chain.rig, scale));
    aiScene& scene = *files.scene;
    scene.mNumMeshes = static_cast<unsigned>(meshes.size());
    scene.mMeshes = arrayOf(meshes);
    scene.mNumMaterials = static_cast<unsigned>(materials.size());
    scene.mMaterials = arrayOf(materials);
    scene.mRootNode = new aiNode("hair");
    setChildren(*scene.mRootNode, nodes);
    return files;
}

/// Binary FBX of assimp, mended: it leaves out the 25 zeros that end lists of nodes, over which readers
/// stumble, its own among them, and puts in the time of writing, so that no two files are alike.
class MendedFbx {
  public:
    explicit MendedFbx(std::vector<std::byte> fbx) : in_(std::move(fbx)) {
        constexpr std::size_t kBeforeNodes = 27;
        std::size_t at = std::min(kBeforeNodes, in_.size());
        out_.assign(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(at));
        while (at + kEnd <= in_.size() && number(at) != 0) at = copyNode(at);
        out_.insert(out_.end(), in_.begin() + static_cast<std::ptrdiff_t>(at), in_.end());
    }
    std::vector<std::byte> take() { return std::move(out_); }

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
        const auto nameLength = std::to_integer<std::size_t>(in_[at + 24]);
        const std::string_view name(reinterpret_cast<const char*>(in_.data()) + at + kEnd, nameLength);
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
    std::vector<std::byte> in_, out_;
};

}  // namespace

Result<std::vector<std::string>> writeCardMeshes(const cards::Chain& chain, CardMeshFormat format,
                                                 const std::filesystem::path& path) {
    const auto isStrands = [](const Level& level) { return level.spec.kind == cards::LevelKind::strands; };
    if (std::ranges::all_of(chain.levels, isStrands))
        return fail("no level that a mesh can hold", "one of cards or a shell");
    auto files = filesOf(chain, format, path);
    if (!files) return tl::unexpected(files.error());
    Assimp::Exporter exporter;
    Assimp::ExportProperties properties;
    properties.SetPropertyString(AI_CONFIG_EXPORT_BLOB_NAME, path.stem().string());
    const aiExportDataBlob* blob = exporter.ExportToBlob(
        files->scene.get(), format == CardMeshFormat::fbx ? "fbx" : "obj", 0u, &properties);
    if (blob == nullptr)
        return fail(fmt::format("assimp: {}", exporter.GetErrorString()), "cards that it can write");
    CardFiles written;
    for (; blob != nullptr; blob = blob->next) {
        std::vector<std::byte> bytes(blob->size);
        std::memcpy(bytes.data(), blob->data, bytes.size());
        if (format == CardMeshFormat::fbx) bytes = MendedFbx(std::move(bytes)).take();
        written.emplace_back(written.empty() ? path : path.parent_path() / blob->name.C_Str(),
                             std::move(bytes));
    }
    std::ranges::move(files->textures, std::back_inserter(written));
    return writeTogether(written);
}

}  // namespace hairloom
