// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/character.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "core/base/parallel.h"

namespace hairloom::cards {
namespace {

/// Of `strands`, the one whose root is nearest to a place; the first of several.
std::uint32_t nearestRoot(const Vec3f& at_ws, std::span<const std::uint32_t> strands,
                          std::span<const Vec3f> roots_ws) {
    std::uint32_t nearest = strands[0];
    float least = std::numeric_limits<float>::infinity();
    for (const std::uint32_t strand : strands) {
        const float distance = (roots_ws[strand] - at_ws).squaredNorm();
        if (distance < least) least = distance, nearest = strand;
    }
    return nearest;
}

struct Influence {
    std::uint16_t joint;
    float weight;
};

/// What a vertex hangs on, with the head's share on the bones of its root.
void hangVertex(const Character::Root& root, std::size_t firstBone, std::array<std::uint16_t, 4>& joints,
                Vec4f& weights) {
    std::array<Influence, 8> all{};
    std::size_t count = 0;
    float ofHead = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const float weight = weights[static_cast<int>(k)];
        if (joints[k] == 0)
            ofHead += weight;
        else if (weight > 0)
            all[count++] = {joints[k], weight};
    }
    if (ofHead == 0) return;
    for (std::size_t k = 0; k < 4; ++k) {
        const float weight = ofHead * root.weights[static_cast<int>(k)];
        if (weight > 0) all[count++] = {static_cast<std::uint16_t>(firstBone + root.bones[k]), weight};
    }
    std::stable_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    joints = {}, weights.setZero();
    for (std::size_t k = 0; k < std::min<std::size_t>(count, 4); ++k)
        joints[k] = all[k].joint, weights[static_cast<int>(k)] = all[k].weight;
    weights /= weights.sum();
}

}  // namespace

void hangOnBones(const Level& level, const Chain& chain, const Character& character, LevelArrays& arrays) {
    if (character.roots.empty()) return;
    const auto* const cards = std::get_if<Cards>(&level.content);
    std::vector<std::uint32_t> all;
    all.resize(chain.roots_ws.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto near = [&](std::size_t v) -> std::span<const std::uint32_t> {
        const std::uint32_t card = cards == nullptr ? kOfCap : cards->mesh.vertices[v].card;
        if (card == kOfCap) return all;
        return cards->cards[card].strands;
    };
    parallelFor(arrays.positions_ws.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const std::uint32_t root = nearestRoot(arrays.positions_ws[v], near(v), chain.roots_ws);
            hangVertex(character.roots[root], chain.rig.joints.size(), arrays.joints[v], arrays.weights[v]);
        }
    });
}

std::vector<std::int32_t> bonesOfChains(const Chain& chain, const Character& character) {
    std::vector<std::int32_t> bones(chain.rig.chains(), character.head);
    if (character.roots.empty() || bones.empty()) return bones;
    std::vector<Vec3f> starts_ws;
    for (const std::vector<Vec3f>& curve : chain.rig.curves) starts_ws.push_back(curve[0]);
    std::vector<std::uint32_t> all(starts_ws.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<std::vector<double>> shares(starts_ws.size(), std::vector<double>(character.bones.size()));
    for (std::size_t s = 0; s < character.roots.size(); ++s) {
        std::vector<double>& share = shares[nearestRoot(chain.roots_ws[s], all, starts_ws)];
        const Character::Root& root = character.roots[s];
        for (std::size_t k = 0; k < 4; ++k)
            share[root.bones[k]] += static_cast<double>(root.weights[static_cast<int>(k)]);
    }
    for (std::size_t c = 0; c < bones.size(); ++c) {
        const auto most = std::ranges::max_element(shares[c]);
        if (*most > 0) bones[c] = static_cast<std::int32_t>(most - shares[c].begin());
    }
    return bones;
}

}  // namespace hairloom::cards
