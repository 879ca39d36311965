// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Linear blend skinning.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom {

/// Bones that move a vertex, at most.
inline constexpr std::size_t kBonesOfVertex = 8;

/// Weights are ≥ 0 and add up to 1, or are all 0 for a vertex that nothing moves.
struct SkinWeights {
    std::vector<std::array<std::uint32_t, kBonesOfVertex>> bones;
    std::vector<std::array<float, kBonesOfVertex>> weights;

    std::size_t vertexCount() const { return weights.size(); }
};

/// Errors: unequal arrays, a bone beyond `boneCount`, a weight that is negative or not finite, weights whose
/// sum is neither 0 nor 1 within 1e-3.
Status validate(const SkinWeights& skin, std::size_t boneCount);

/// The strongest of any number of influences, strongest first and scaled to add up to 1; `most` of them.
void setStrongest(SkinWeights& skin, std::size_t vertex,
                  std::vector<std::pair<std::uint32_t, float>> influences, std::size_t most = kBonesOfVertex);

/// Of a vertex, for formats that have four. Weights add up to 1, or are all 0.
struct FourWeights {
    std::array<std::uint32_t, 4> bones{};
    std::array<float, 4> weights{};
};
FourWeights strongestFour(const SkinWeights& skin, std::size_t vertex);

/// Posed positions, metres. All arrays have one entry per vertex; `matrices` one per bone, from
/// skinMatrices().
void skinPositions(std::span<const Vec3f> rest, const SkinWeights& skin,
                   std::span<const Eigen::Affine3f> matrices, std::span<Vec3f> posed);

/// Posed normals, unit length: the blended matrix' cofactors applied to the rest normal, which stays
/// perpendicular under any scale. A matrix that flattens the normal away leaves it at rest.
void skinNormals(std::span<const Vec3f> rest, const SkinWeights& skin,
                 std::span<const Eigen::Affine3f> matrices, std::span<Vec3f> posed);

}  // namespace hairloom
