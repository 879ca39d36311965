// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/root_grid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hairloom::editing {
namespace {

std::int64_t indexOf(float coordinate, float cell) {
    return static_cast<std::int64_t>(std::floor(coordinate / cell));
}

/// 21 bits of each index; cells that share a key by chance only make a search longer.
std::uint64_t keyOf(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::uint64_t kMask = (1ull << 21u) - 1;
    return ((static_cast<std::uint64_t>(x) & kMask) << 42u) |
           ((static_cast<std::uint64_t>(y) & kMask) << 21u) | (static_cast<std::uint64_t>(z) & kMask);
}

}  // namespace

void RootGrid::add(std::uint32_t strand, const Vec3f& root_ss) {
    const std::uint64_t key =
        keyOf(indexOf(root_ss.x(), cell_), indexOf(root_ss.y(), cell_), indexOf(root_ss.z(), cell_));
    cells_[key].push_back({strand, root_ss});
}

template <class Visit>
bool RootGrid::visit(const Vec3f& point, float radius, Visit visit) const {
    const auto low = [&](Eigen::Index i) { return indexOf(point[i] - radius, cell_); };
    const auto high = [&](Eigen::Index i) { return indexOf(point[i] + radius, cell_); };
    for (std::int64_t z = low(2); z <= high(2); ++z)
        for (std::int64_t y = low(1); y <= high(1); ++y)
            for (std::int64_t x = low(0); x <= high(0); ++x) {
                const auto found = cells_.find(keyOf(x, y, z));
                if (found == cells_.end()) continue;
                for (const Entry& entry : found->second) {
                    const float distance = (entry.root - point).norm();
                    if (distance <= radius && !visit(entry.strand, distance)) return false;
                }
            }
    return true;
}

std::vector<RootGrid::Neighbour> RootGrid::nearest(const Vec3f& point_ss, std::size_t count,
                                                   float radius) const {
    std::vector<Neighbour> found;
    // No farther than needed: where roots are dense the whole radius would hold thousands.
    for (float reach = std::min(0.5f * cell_, radius);; reach = std::min(2 * reach, radius)) {
        found.clear();
        visit(point_ss, reach, [&](std::uint32_t strand, float distance) {
            found.push_back({strand, distance});
            return true;
        });
        if (found.size() >= count || reach >= radius) break;
    }
    const std::size_t maximum = std::min(count, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(maximum), found.end(),
                      [](const Neighbour& a, const Neighbour& b) {
                          return std::tie(a.distance, a.strand) < std::tie(b.distance, b.strand);
                      });
    found.resize(maximum);
    return found;
}

bool RootGrid::anyWithin(const Vec3f& point_ss, float radius) const {
    return !visit(point_ss, radius, [](std::uint32_t, float) { return false; });
}

std::size_t RootGrid::countWithin(const Vec3f& point_ss, float radius) const {
    std::size_t count = 0;
    visit(point_ss, radius, [&](std::uint32_t, float) {
        ++count;
        return true;
    });
    return count;
}

}  // namespace hairloom::editing
