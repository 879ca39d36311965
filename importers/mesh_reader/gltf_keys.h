// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Keys of glTF's animations as tracks, which are linear.

#include "core/animation/clip.h"
#include "importers/mesh_reader/gltf_file.h"

namespace tinygltf {
struct Animation;
struct AnimationChannel;
}  // namespace tinygltf

namespace hairloom {

/// Largest difference between a cubic spline and the straight pieces that it becomes: metres, factors,
/// weights of morph targets, and components of a quaternion of unit length.
inline constexpr float kCubicTolerance = 1e-5f;

/// The track of `channel` that the source moves. A step becomes two keys that follow each other as closely as
/// numbers do, a cubic spline as many straight pieces as it takes, at most 64 between two keys. Keys that do
/// not come later than the one before are left out. Errors: accessors that do not fit one another, an
/// interpolation that is none.
Status readKeys(const GltfFile& file, const tinygltf::Animation& animation,
                const tinygltf::AnimationChannel& source, Channel& channel);

/// The weights of morph targets that the source moves: a track for each of the node's targets, in their
/// order, without keys where it is not wanted. Keys as in readKeys(). Errors: as there, numbers for fewer or
/// more targets, numbers that are not finite.
Result<std::vector<Track<float>>> readWeights(const GltfFile& file, const tinygltf::Animation& animation,
                                              const tinygltf::AnimationChannel& source,
                                              const std::vector<bool>& wanted);

}  // namespace hairloom
