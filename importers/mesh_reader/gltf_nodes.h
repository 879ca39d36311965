// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Nodes, skins and animations of a glTF file as bones, weights and clips.

#include <cstdint>
#include <string>
#include <vector>

#include "importers/mesh_reader/gltf_file.h"
#include "importers/mesh_reader/gltf_morphs.h"
#include "importers/raw_scene.h"

namespace hairloom {

/// The nodes that move something: joints of skins, nodes with a channel, meshes without a skin that morph,
/// and all nodes above these.
class GltfNodes {
  public:
    /// Fills scene.bones. Errors: nodes that are no forest, joints and channels without a node.
    static Result<GltfNodes> make(const GltfFile& file, RawScene& scene);

    /// The nodes of the scene that the file shows, parents first, children in the file's order.
    const std::vector<std::uint32_t>& shown() const { return shown_; }
    std::string nameOf(std::uint32_t node) const;

    /// From the node's own space to the world at rest.
    Eigen::Affine3f worldOf(std::uint32_t node) const;
    /// From the space of a node's mesh: a skinned mesh stands where the topmost of its joints carries it.
    Eigen::Affine3f meshToWorld(std::uint32_t node) const;

    /// Appends weights of `count` vertices of a node's mesh. `influences` are joint and weight of each, by
    /// the node's skin; empty where the node has none. Errors: a joint that the skin does not have.
    Status addWeights(std::uint32_t node, std::size_t count,
                      std::vector<std::vector<std::pair<std::uint32_t, float>>> influences);

    /// Fills scene.clips. Errors: accessors that do not fit.
    Status addClips(GltfMorphs& morphs);

  private:
    struct Skin {
        std::vector<std::uint32_t> joints;  ///< nodes
        std::vector<Eigen::Affine3f> inverseBind;
    };

    GltfNodes(const GltfFile& file, RawScene& scene) : file_(&file), scene_(&scene) {}
    Status findParents();
    Status findShown();
    Status readSkins();
    void addBones();
    /// Of all nodes, parents first.
    std::vector<std::uint32_t> inOrder() const;
    std::uint32_t boneFor(std::uint32_t bone, const Eigen::Affine3f& inverseBind);
    std::uint32_t carrierOf(std::uint32_t node);
    Result<Clip> convertClip(std::size_t animation, GltfMorphs& morphs) const;

    const GltfFile* file_;
    RawScene* scene_;
    std::vector<std::uint32_t> parents_;     ///< node of each node, kNoBone at the top
    std::vector<std::uint32_t> boneOfNode_;  ///< kNoBone where it moves nothing
    std::vector<std::uint32_t> shown_;
    std::vector<Skin> skins_;
    std::vector<bool> bound_;  ///< per bone: inverseBind comes from a skin
    std::vector<std::vector<std::uint32_t>>
        duplicates_;  ///< per bone: bones at the same place, bound otherwise
};

}  // namespace hairloom
