// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bones, weights and clips of an assimp scene.

#include <assimp/scene.h>

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/mesh_reader/assimp_morphs.h"
#include "importers/raw_scene.h"

namespace hairloom {

Eigen::Affine3f toAffine(const aiMatrix4x4& matrix);

/// The nodes that move something: joints of skins, nodes with a channel, meshes without a skin that morph,
/// and all nodes above these.
class SkeletonBuilder {
  public:
    /// Fills scene.bones. `toWorld` turns the file's axes so that Y is up.
    SkeletonBuilder(const aiScene& source, const Eigen::Affine3f& toWorld, bool ignoreSkinnedNodes,
                    const AssimpMorphs& morphs, RawScene& scene);

    /// From the mesh's own space to the world at rest: through its node, or, where a skinned mesh's node is
    /// to be ignored as in glTF, where the topmost of its joints carries it.
    Eigen::Affine3f meshToWorld(const aiMesh& mesh, const aiNode& node) const;

    /// Appends skin weights for the vertices of one mesh of that node.
    void addWeights(const aiMesh& mesh, const aiNode& node, const Eigen::Affine3f& meshToWorld);

    void addClips(AssimpMorphs& morphs);

    Eigen::Affine3f worldOf(const aiNode& node) const;

  private:
    void addBones(const aiNode& node, std::uint32_t parent);
    bool isNeeded(const aiNode& node) const;
    std::uint32_t boneFor(std::uint32_t bone, const Eigen::Affine3f& inverseBind);
    /// The bone that moves a mesh without a skin, or kNoBone.
    std::uint32_t carrierOf(const aiNode& node);
    Clip convertClip(const aiAnimation& animation, AssimpMorphs& morphs) const;

    const aiScene& source_;
    Eigen::Affine3f toWorld_;
    bool ignoreSkinnedNodes_;
    RawScene& scene_;
    std::unordered_map<const aiNode*, std::uint32_t> boneOfNode_;
    std::unordered_map<std::string, const aiNode*> nodeOfName_;
    std::set<const aiNode*> needed_;
    std::vector<bool> bound_;  ///< per bone: inverseBind comes from a skin
    std::vector<std::vector<std::uint32_t>>
        duplicates_;  ///< per bone: bones at the same place, bound otherwise
};

}  // namespace hairloom
