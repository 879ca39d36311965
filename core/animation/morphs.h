// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Morph targets: shapes that move vertices of a mesh by a weight, before bones move them. Also called blend
// shapes (FBX) and shape keys.

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/scalp_mesh.h"

namespace hairloom {

struct MorphTarget {
    std::string name;                     ///< may repeat
    float restWeight = 0;                 ///< that the mesh's rest positions have
    std::vector<std::uint32_t> vertices;  ///< that it moves, each once, in any order
    std::vector<Vec3f> offsets;           ///< of these at weight 1; metres, in the mesh's rest space
};

/// Errors: unequal arrays, a vertex beyond `vertexCount`, an offset or a weight that is not finite.
Status validate(std::span<const MorphTarget> targets, std::size_t vertexCount);

/// Of a mesh that consists of `vertices` of the one that the targets are of, in this order. A vertex may be
/// there several times or not at all. Targets that would bring what all move above `most` move nothing.
std::vector<MorphTarget> morphsOf(std::span<const MorphTarget> targets,
                                  std::span<const std::uint32_t> vertices,
                                  std::size_t most = std::numeric_limits<std::size_t>::max());

/// Weights `share` 0 … 1 of the way, one a target. Either may be empty, which stands for those of rest.
std::vector<float> blended(std::span<const MorphTarget> targets, std::span<const float> from,
                           std::span<const float> to, float share);

/// Positions at these weights, one a target; metres, rest space. Empty where all targets have their weights
/// of rest.
std::vector<Vec3f> morphedPositions(std::span<const Vec3f> rest, std::span<const MorphTarget> targets,
                                    std::span<const float> weights);

/// Normals of the mesh, unit length, turned as far as its faces turn when its vertices go to `positions`.
std::vector<Vec3f> morphedNormals(const ScalpMesh& mesh, std::span<const Vec3f> positions);

}  // namespace hairloom
