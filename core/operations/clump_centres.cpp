// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/clump_centres.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 1024;

/// All strands that can lead, in an order that depends on seed and id alone.
std::vector<std::uint32_t> randomOrder(const Groom& groom, std::uint64_t seed) {
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (groom.offsets[s + 1] - groom.offsets[s] < 2 || !groom.strand(s)[0].allFinite()) continue;
        const std::uint64_t id = s < ids.size() ? ids[s] : s;
        keyed.emplace_back(Random::mix(Random::mix(seed) ^ id), static_cast<std::uint32_t>(s));
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::uint32_t> order;
    for (const auto& [key, strand] : keyed) order.push_back(strand);
    return order;
}

}  // namespace

std::uint32_t CentreGrid::nearest(const Vec3f& root) const {
    const Cell home = cellOf(root);
    std::uint32_t best = kNone;
    float bestDistance = spacing_;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const auto found = cells_.find(keyOf({home[0] + x, home[1] + y, home[2] + z}));
                if (found == cells_.end()) continue;
                for (const std::uint32_t centre : found->second) {
                    const float distance = (groom_.strand(centre)[0] - root).norm();
                    if (distance > bestDistance || (distance == bestDistance && centre > best)) continue;
                    bestDistance = distance;
                    best = centre;
                }
            }
    return best;
}

void CentreGrid::add(std::uint32_t strand) {
    cells_[keyOf(cellOf(groom_.strand(strand)[0]))].push_back(strand);
}

CentreGrid::Cell CentreGrid::cellOf(const Vec3f& p) const {
    // Far coordinates share a border cell; that costs time, not correctness.
    constexpr float kFar = 1e15f;
    const auto index = [&](float x) {
        return static_cast<std::int64_t>(std::floor(std::clamp(x / spacing_, -kFar, kFar)));
    };
    return {index(p.x()), index(p.y()), index(p.z())};
}

std::uint64_t CentreGrid::keyOf(const Cell& cell) {
    std::uint64_t key = 0;
    for (const std::int64_t part : cell) key = Random::mix(key ^ static_cast<std::uint64_t>(part));
    return key;
}

std::vector<std::uint32_t> chooseCentres(const Groom& groom, float spacing, std::uint64_t seed) {
    const std::vector<std::uint32_t> order = randomOrder(groom, seed);
    CentreGrid grid(groom, spacing);
    for (const std::uint32_t strand : order) {
        if (grid.nearest(groom.strand(strand)[0]) == CentreGrid::kNone) grid.add(strand);
    }
    std::vector<std::uint32_t> centres(groom.strandCount());
    std::iota(centres.begin(), centres.end(), 0u);
    parallelFor(order.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t nearest = grid.nearest(groom.strand(order[i])[0]);
            if (nearest != CentreGrid::kNone) centres[order[i]] = nearest;
        }
    });
    return centres;
}

}  // namespace hairloom
