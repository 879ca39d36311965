// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/animation/skinning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/base/parallel.h"

namespace hairloom {
namespace {

constexpr std::size_t kVerticesPerPiece = 2048;

using Blend = Eigen::Matrix<float, 3, 4>;

Blend blendAt(const SkinWeights& skin, std::size_t vertex, std::span<const Eigen::Affine3f> matrices) {
    Blend blend = Blend::Zero();
    float sum = 0;
    for (std::size_t slot = 0; slot < kBonesOfVertex; ++slot) {
        const float weight = skin.weights[vertex][slot];
        if (weight == 0) continue;
        blend += weight * matrices[skin.bones[vertex][slot]].matrix().topRows<3>();
        sum += weight;
    }
    if (sum == 0) blend.leftCols<3>().setIdentity();
    return blend;
}

template <class PerVertex>
void forEachBlend(const SkinWeights& skin, std::span<const Eigen::Affine3f> matrices,
                  const PerVertex& perVertex) {
    parallelFor(skin.vertexCount(), kVerticesPerPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t vertex = begin; vertex < end; ++vertex)
            perVertex(vertex, blendAt(skin, vertex, matrices));
    });
}

}  // namespace

Status validate(const SkinWeights& skin, std::size_t boneCount) {
    if (skin.bones.size() != skin.weights.size()) {
        return fail(
            fmt::format("{} bone entries for {} weight entries", skin.bones.size(), skin.weights.size()));
    }
    for (std::size_t vertex = 0; vertex < skin.vertexCount(); ++vertex) {
        float sum = 0;
        for (std::size_t slot = 0; slot < kBonesOfVertex; ++slot) {
            const float weight = skin.weights[vertex][slot];
            if (!std::isfinite(weight) || weight < 0) {
                return fail(fmt::format("vertex {} has the skin weight {}", vertex, weight),
                            "expected 0 … 1");
            }
            if (weight > 0 && skin.bones[vertex][slot] >= boneCount) {
                return fail(fmt::format("vertex {} follows bone {}", vertex, skin.bones[vertex][slot]),
                            fmt::format("there are {} bones", boneCount));
            }
            sum += weight;
        }
        if (sum != 0 && std::abs(sum - 1) > 1e-3f) {
            return fail(fmt::format("the skin weights of vertex {} add up to {}", vertex, sum), "expected 1");
        }
    }
    return {};
}

void setStrongest(SkinWeights& skin, std::size_t vertex,
                  std::vector<std::pair<std::uint32_t, float>> influences, std::size_t most) {
    assert(most <= kBonesOfVertex);
    std::ranges::stable_sort(influences, [](const auto& a, const auto& b) { return a.second > b.second; });
    if (influences.size() > most) influences.resize(most);
    float sum = 0;
    for (const auto& influence : influences) sum += influence.second;
    skin.bones[vertex] = {};
    skin.weights[vertex] = {};
    if (!(sum > 0)) return;
    for (std::size_t slot = 0; slot < influences.size(); ++slot) {
        skin.bones[vertex][slot] = influences[slot].first;
        skin.weights[vertex][slot] = influences[slot].second / sum;
    }
}

FourWeights strongestFour(const SkinWeights& skin, std::size_t vertex) {
    std::vector<std::pair<std::uint32_t, float>> influences;
    for (std::size_t slot = 0; slot < kBonesOfVertex; ++slot) {
        if (skin.weights[vertex][slot] > 0)
            influences.emplace_back(skin.bones[vertex][slot], skin.weights[vertex][slot]);
    }
    SkinWeights one{{{}}, {{}}};
    setStrongest(one, 0, std::move(influences), 4);
    FourWeights four;
    std::copy_n(one.bones[0].begin(), 4, four.bones.begin());
    std::copy_n(one.weights[0].begin(), 4, four.weights.begin());
    return four;
}

void skinPositions(std::span<const Vec3f> rest, const SkinWeights& skin,
                   std::span<const Eigen::Affine3f> matrices, std::span<Vec3f> posed) {
    assert(rest.size() == skin.vertexCount() && posed.size() == rest.size());
    forEachBlend(skin, matrices, [&](std::size_t vertex, const Blend& blend) {
        posed[vertex] = blend.leftCols<3>() * rest[vertex] + blend.col(3);
    });
}

void skinNormals(std::span<const Vec3f> rest, const SkinWeights& skin,
                 std::span<const Eigen::Affine3f> matrices, std::span<Vec3f> posed) {
    assert(rest.size() == skin.vertexCount() && posed.size() == rest.size());
    forEachBlend(skin, matrices, [&](std::size_t vertex, const Blend& blend) {
        const Vec3f x = blend.col(0), y = blend.col(1), z = blend.col(2);
        Mat3f cofactors;
        cofactors << y.cross(z), z.cross(x), x.cross(y);
        const Vec3f normal = cofactors * rest[vertex];
        const float length = normal.norm();
        const bool usable = std::isfinite(length) && length > 0;
        posed[vertex] = usable ? Vec3f(normal / length) : rest[vertex];
    });
}

}  // namespace hairloom
