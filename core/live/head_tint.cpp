// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/head_tint.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/smooth_step.h"
#include "core/editing/root_grid.h"

namespace hairloom {
namespace {

constexpr std::size_t kMostRoots = 20'000;  // enough to tell where hair grows
constexpr std::size_t kProbes = 500;
constexpr std::size_t kNeighbours = 4;
constexpr float kDense = 1, kBare = 2.5f;  // distance of the fourth root, in typical ones
constexpr float kWidest_m = 0.008f;  // over which it fades: hair of few, thick strands has a hairline, too
constexpr float kShare = 0.5f;       // of hair's colour in the skin under it

/// Evenly picked from the strands, which are in no order of place that this could meet.
std::vector<Vec3f> someRoots(const Groom& groom) {
    const std::size_t count = groom.strandCount(), taken = std::min(count, kMostRoots);
    std::vector<Vec3f> roots;
    for (std::size_t i = 0; i < taken; ++i)
        roots.push_back(groom.strand(static_cast<std::uint32_t>(i * count / taken)).front());
    return roots;
}

float areaOf(const Groom& groom) {
    float area = 0;
    for (const std::uint32_t face : groom.scalpSelection) area += groom.scalp->triangleArea(face);
    return area;
}

/// Distance of the fourth root from a place; more than `radius` where there is none so near.
float distanceOfFourth(const editing::RootGrid& grid, const Vec3f& place, float radius, std::size_t first) {
    const auto found = grid.nearest(place, first + kNeighbours, radius);
    return found.size() < first + kNeighbours ? 2 * radius : found.back().distance;
}

}  // namespace

std::vector<float> headTint(const Groom& groom) {
    std::vector<float> shares(groom.scalp->vertexCount(), 0.0f);
    const std::vector<Vec3f> roots = someRoots(groom);
    // As far apart as they would be evenly on their scalp.
    const float even = std::sqrt(areaOf(groom) / static_cast<float>(std::max<std::size_t>(roots.size(), 1)));
    if (roots.size() <= kNeighbours || !(even > 0) || !std::isfinite(even)) return shares;
    editing::RootGrid grid(2 * even);
    for (std::size_t i = 0; i < roots.size(); ++i) grid.add(static_cast<std::uint32_t>(i), roots[i]);
    std::vector<float> distances;
    const std::size_t probes = std::min(roots.size(), kProbes);
    for (std::size_t i = 0; i < probes; ++i)
        distances.push_back(distanceOfFourth(grid, roots[i * roots.size() / probes], 4 * even, 1));
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    // Of hair in tufts, whose strands share their roots, most are at no distance.
    const float typical = std::max(*middle, 0.1f * even);
    const float fade = std::min((kBare - kDense) * typical, kWidest_m), dense = kDense * typical;
    const std::span<const Vec3f> positions = groom.scalp->positions();
    Box3f reached;
    for (const Vec3f& root : roots) reached.extend(root);
    reached =
        Box3f(reached.min() - Vec3f::Constant(dense + fade), reached.max() + Vec3f::Constant(dense + fade));
    parallelFor(positions.size(), 512, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v) {
            if (!reached.contains(positions[v])) continue;
            const float distance = distanceOfFourth(grid, positions[v], dense + fade, 0);
            shares[v] = kShare * (1 - smoothStep(dense, dense + fade, distance));
        }
    });
    return shares;
}

std::vector<Vec3f> tinted(const Vec3f& skin, const Vec3f& colour, std::span<const float> shares) {
    std::vector<Vec3f> albedo;
    albedo.reserve(shares.size());
    for (const float share : shares) albedo.push_back((1 - share) * skin + share * colour);
    return albedo;
}

}  // namespace hairloom
