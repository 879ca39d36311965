// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Blend shapes of an assimp scene, those that its clips move.

#include <assimp/scene.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/raw_scene.h"

namespace hairloom {

/// assimp gives shapes by mesh, without the weights that they have at rest, and keys by the node's name and
/// the number of the shape's channel. What these do not tell apart is left out and told.
class AssimpMorphs {
  public:
    AssimpMorphs(const aiScene& source, RawScene& scene);

    /// Whether a clip moves shapes of the node's meshes.
    bool isMoved(const aiNode& node) const { return nodes_.contains(node.mName.C_Str()); }
    /// Takes the shapes of one of a node's meshes, whose vertices were appended to the soup from `first` on.
    void add(const aiMesh& mesh, const aiNode& node, std::uint32_t first, const Mat3f& toWorld);
    /// The tracks of a clip, after all meshes were added.
    void addChannels(const aiAnimation& animation, double ticksPerSecond, Clip& clip);
    void finish();

  private:
    const aiScene& source_;
    RawScene& scene_;
    std::unordered_map<std::string, std::vector<std::uint32_t>> nodes_;  ///< targets by the node's name
    std::size_t inBetween_ = 0, notFinite_ = 0, tooMany_ = 0, moved_ = 0;
};

}  // namespace hairloom
