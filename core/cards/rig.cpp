// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/rig.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"

namespace hairloom::cards {
namespace {

/// The two chains nearest to a card, and the share of the first.
struct Hold {
    std::array<std::uint32_t, 2> chains{0, 0};
    float share = 1;
};

Hold holdOf(const Strip& strip, const std::vector<std::vector<Vec3f>>& chains) {
    constexpr float kAnything = std::numeric_limits<float>::infinity();
    std::array<float, 2> nearest{kAnything, kAnything};
    Hold hold;
    for (std::uint32_t c = 0; c < chains.size(); ++c) {
        float distance = 0;
        for (std::size_t k = 0; k < strip.stations(); ++k)
            distance += (strip.centre[k] - chains[c][k]).squaredNorm();
        distance += 1e-12f;
        if (distance < nearest[0]) {
            nearest = {distance, nearest[0]}, hold.chains = {c, hold.chains[0]};
        } else if (distance < nearest[1]) {
            nearest[1] = distance, hold.chains[1] = c;
        }
    }
    if (nearest[1] < kAnything) hold.share = nearest[1] / (nearest[0] + nearest[1]);
    return hold;
}

}  // namespace

Result<Rig> makeRig(const Cards& cards, std::uint32_t chains, std::uint32_t perChain, Cancel cancel) {
    EvenHair middles;
    middles.stations = kStations;
    std::vector<Vec3f> normals;
    for (const Card& card : cards.cards) {
        middles.points_ws.insert(middles.points_ws.end(), card.strip.centre.begin(), card.strip.centre.end());
        middles.lengths.push_back(card.strip.length());
        middles.weights.push_back(card.strip.length());
        normals.push_back(card.strip.normal[0]);
    }
    std::vector<std::uint32_t> all(cards.cards.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto clusters = clusterHair(middles, std::move(all), normals, {chains, 0}, cancel);
    if (!clusters) return tl::unexpected(clusters.error());
    Rig rig;
    rig.perChain = perChain;
    Vec3f roots = Vec3f::Zero();
    for (std::size_t c = 0; c < clusters->size(); ++c) {
        for (std::uint32_t j = 0; j < perChain; ++j) {
            const std::size_t k = std::size_t{j} * (kStations - 1) / (perChain - 1);
            const std::int32_t before = j == 0 ? 0 : static_cast<std::int32_t>(rig.joints.size()) - 1;
            rig.joints.push_back({(*clusters)[c].strip.centre[k], before});
        }
        rig.curves.push_back((*clusters)[c].strip.centre);
        roots += (*clusters)[c].strip.centre[0] / static_cast<float>(clusters->size());
    }
    rig.joints[0].position_ws = roots;
    return rig;
}

Binding bind(const Rig& rig, const Cards& cards) {
    std::vector<Hold> holds;
    for (const Card& card : cards.cards) holds.push_back(holdOf(card.strip, rig.curves));
    Binding binding;
    for (const CardVertex& vertex : cards.mesh.vertices) {
        if (vertex.card == kOfCap) {
            binding.joints.push_back({}), binding.weights.emplace_back(1, 0, 0, 0);
            continue;
        }
        const Hold& hold = holds[vertex.card];
        const float at = vertex.hangs * static_cast<float>(rig.perChain - 1);
        const auto joint = std::min(static_cast<std::uint32_t>(at), rig.perChain - 2);
        const float next = at - static_cast<float>(joint);
        const float a = hold.share, b = 1 - hold.share;
        const Vec4f weights(a * (1 - next), a * next, b * (1 - next), b * next);
        std::array<std::uint16_t, 4> joints{};
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t of = 1 + hold.chains[k / 2] * rig.perChain + joint + k % 2;
            // Roots stay on the skin, however a chain turns.
            const bool isRoot = joint + k % 2 == 0;
            if (weights[static_cast<int>(k)] > 0 && !isRoot) joints[k] = static_cast<std::uint16_t>(of);
        }
        binding.joints.push_back(joints);
        binding.weights.push_back(weights);
    }
    return binding;
}

void skin(const Binding& binding, const CardMesh& mesh, std::span<const Eigen::Affine3f> motions,
          std::span<Vec3f> positions_ws) {
    parallelFor(mesh.vertices.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Vec3f sum = Vec3f::Zero();
            for (std::size_t k = 0; k < 4; ++k) {
                sum += binding.weights[v][static_cast<int>(k)] *
                       (motions[binding.joints[v][k]] * mesh.vertices[v].position_ws);
            }
            positions_ws[v] = sum;
        }
    });
}

}  // namespace hairloom::cards
