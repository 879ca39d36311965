// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Morph targets of a glTF file, those that its clips move.

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/mesh_reader/gltf_file.h"
#include "importers/raw_scene.h"

namespace tinygltf {
struct Animation;
struct Node;
struct Primitive;
}  // namespace tinygltf

namespace hairloom {

/// Weights of rest of a node's mesh: the node's own, else the mesh's. May be fewer than there are targets.
const std::vector<double>& restWeightsOf(const tinygltf::Model& model, const tinygltf::Node& node);

/// What does not fit is left out and told, whatever it is: the head is whole without.
class GltfMorphs {
  public:
    GltfMorphs(const GltfFile& file, RawScene& scene);

    /// Takes the targets of a primitive of a node, whose vertices were appended to the soup from `first` on.
    void add(std::uint32_t node, const tinygltf::Primitive& primitive, std::uint32_t first, std::size_t count,
             const Mat3f& toWorld);
    /// All primitives were added: targets that move nothing vanish, and what was left out is told.
    void finish();
    /// The tracks of a clip's weights, after finish(). `clip` has its name.
    void addChannels(const tinygltf::Animation& animation, Clip& clip);

  private:
    struct OfNode {
        std::vector<std::uint32_t> targets;  ///< in scene.morphs, kNoMorph where it is left out
        std::vector<bool> isBroken;
    };
    std::string nameOf(std::uint32_t node, std::size_t target) const;
    void leaveOut(std::uint32_t node, std::size_t target, const std::string& why);

    const GltfFile& file_;
    RawScene& scene_;
    std::unordered_map<std::uint32_t, OfNode> nodes_;  ///< those whose weights clips move
    std::vector<std::string> leftOut_;
    std::size_t moved_ = 0;  ///< vertices
    bool isFull_ = false;    ///< those that come are left out
};

}  // namespace hairloom
