// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/strand_pairs.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <unordered_map>

namespace hairloom {
namespace {

struct RootHash {
    std::size_t operator()(const Vec3f& root) const {
        std::uint64_t hash = 0;
        // FNV-1a over words, with its spread of 64 bits. Equal numbers have equal bits but for zero.
        for (int c = 0; c < 3; ++c)
            hash = (hash ^ std::bit_cast<std::uint32_t>(root[c] == 0 ? 0.0f : root[c])) * 0x9e3779b97f4a7c15u;
        return static_cast<std::size_t>(hash ^ (hash >> 32u));
    }
};

template <class Key, class Hash = std::hash<Key>>
using Strands = std::unordered_map<Key, std::uint32_t, Hash>;

/// Strands by a key; nothing where it is missing or repeats.
std::optional<Strands<std::uint32_t>> byId(const Groom& groom) {
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    if (ids.size() != groom.strandCount()) return std::nullopt;
    Strands<std::uint32_t> strands;
    strands.reserve(ids.size());
    for (std::uint32_t s = 0; s < ids.size(); ++s)
        if (!strands.emplace(ids[s], s).second) return std::nullopt;
    return strands;
}

std::optional<Strands<Vec3f, RootHash>> byRoot(const Groom& groom) {
    Strands<Vec3f, RootHash> strands;
    strands.reserve(groom.strandCount());
    for (std::uint32_t s = 0; s < groom.strandCount(); ++s) {
        const auto points = groom.strand(s);
        // What is not a number equals nothing, itself included.
        if (points.empty() || !points[0].allFinite() || !strands.emplace(points[0], s).second)
            return std::nullopt;
    }
    return strands;
}

template <class Map>
void pairByKey(const Map& before, const Map& after, StrandPairs& matched) {
    for (const auto& [key, strand] : before)
        if (const auto found = after.find(key); found != after.end())
            matched.pairs.emplace_back(strand, found->second);
    std::ranges::sort(matched.pairs);
}

void pairByOrder(const Groom& before, const Groom& after, StrandPairs& matched) {
    const auto count = static_cast<std::uint32_t>(std::min(before.strandCount(), after.strandCount()));
    matched.pairs.reserve(count);
    for (std::uint32_t s = 0; s < count; ++s) matched.pairs.emplace_back(s, s);
}

}  // namespace

bool StrandPairs::inOrder() const {
    return std::ranges::is_sorted(pairs, {}, [](const auto& pair) { return pair.second; });
}

StrandPairs pairStrands(const Groom& before, const Groom& after) {
    StrandPairs matched;
    const auto oldIds = byId(before), newIds = byId(after);
    if (oldIds && newIds) {
        pairByKey(*oldIds, *newIds, matched);
    } else {
        matched.match = StrandMatch::order;
        if (before.strandCount() != after.strandCount()) {
            const auto oldRoots = byRoot(before), newRoots = byRoot(after);
            if (oldRoots && newRoots) {
                matched.match = StrandMatch::roots;
                pairByKey(*oldRoots, *newRoots, matched);
            }
        }
        if (matched.match == StrandMatch::order) pairByOrder(before, after, matched);
    }
    matched.removed = before.strandCount() - matched.pairs.size();
    matched.added = after.strandCount() - matched.pairs.size();
    return matched;
}

}  // namespace hairloom
