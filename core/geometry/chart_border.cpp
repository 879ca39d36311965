// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/chart_border.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

namespace hairloom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr double kDrawnIn = 1e-6;

Kernel::Point_2 toCgal(const Vec2d& p) {
    return {p.x(), p.y()};
}
Kernel::Segment_2 toCgal(const SegmentGrid::Segment& s) {
    return {toCgal(s[0]), toCgal(s[1])};
}
Kernel::Triangle_2 toCgal(const ChartBorder::Corners& c) {
    return {toCgal(c[0]), toCgal(c[1]), toCgal(c[2])};
}

}  // namespace

ChartBorder::ChartBorder(const ScalpMesh& mesh, const Chart& chart)
    : grid_(flatBorder(oppositeSides(mesh, chart.faces), chart.cornerUvs)) {
    for (std::uint32_t s = 0; s < grid_.segments().size(); ++s)
        for (const Vec2d& end : grid_.segments()[s]) around_[{end.x(), end.y()}].push_back(s);
}

double ChartBorder::overhang(const Corners& corners) {
    const Vec2d middle = (corners[0] + corners[1] + corners[2]) / 3;
    Corners inner;
    for (std::size_t i = 0; i < 3; ++i) inner[i] = corners[i] + kDrawnIn * (middle - corners[i]);
    const Kernel::Triangle_2 triangle = toCgal(inner);
    if (triangle.is_degenerate()) return kBridges;
    grid_.near(inner[0].cwiseMin(inner[1]).cwiseMin(inner[2]), inner[0].cwiseMax(inner[1]).cwiseMax(inner[2]),
               found_);
    std::erase_if(
        found_, [&](std::uint32_t s) { return !CGAL::do_intersect(triangle, toCgal(grid_.segments()[s])); });
    taken_.assign(found_.size(), false);
    double deepest = 0;
    for (std::size_t i = 0; i < found_.size() && deepest < kBridges; ++i)
        if (!taken_[i]) deepest = std::max(deepest, overhangOf(takeChain(i, inner), inner));
    return deepest;
}

bool ChartBorder::sees(const Vec2d& a, const Vec2d& b) {
    const SegmentGrid::Segment inner{a + kDrawnIn * (b - a), b + kDrawnIn * (a - b)};
    grid_.near(inner[0].cwiseMin(inner[1]), inner[0].cwiseMax(inner[1]), found_);
    return std::none_of(found_.begin(), found_.end(), [&](std::uint32_t s) {
        return CGAL::do_intersect(toCgal(inner), toCgal(grid_.segments()[s]));
    });
}

/// The found segments that hang together inside the triangle with one of them.
std::vector<std::uint32_t> ChartBorder::takeChain(std::size_t first, const Corners& corners) {
    const Kernel::Triangle_2 triangle = toCgal(corners);
    taken_[first] = true;
    std::vector<std::uint32_t> chain{found_[first]};
    for (std::size_t next = 0; next < chain.size(); ++next)
        for (const Vec2d& end : grid_.segments()[chain[next]]) {
            if (triangle.has_on_unbounded_side(toCgal(end))) continue;
            for (const std::uint32_t s : around_.at({end.x(), end.y()})) {
                const auto place = std::lower_bound(found_.begin(), found_.end(), s);
                const auto i = static_cast<std::size_t>(place - found_.begin());
                if (place == found_.end() || *place != s || taken_[i]) continue;
                taken_[i] = true;
                chain.push_back(s);
            }
        }
    return chain;
}

double ChartBorder::overhangOf(const std::vector<std::uint32_t>& chain, const Corners& corners) const {
    double result = kBridges;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d &a = corners[i], &b = corners[(i + 1) % 3];
        const bool cut = std::any_of(chain.begin(), chain.end(), [&](std::uint32_t s) {
            return CGAL::do_intersect(toCgal(SegmentGrid::Segment{a, b}), toCgal(grid_.segments()[s]));
        });
        if (!cut) continue;
        if (result < kBridges) return kBridges;  // a second side
        result = depth(chain, a, b) / (b - a).norm();
    }
    return result;
}

/// The farthest that any end of the segments lies to the left of a → b.
double ChartBorder::depth(const std::vector<std::uint32_t>& chain, const Vec2d& a, const Vec2d& b) const {
    const Vec2d along = (b - a).normalized();
    double maximum = 0;
    for (const std::uint32_t s : chain)
        for (const Vec2d& end : grid_.segments()[s])
            maximum = std::max(maximum, along.x() * (end - a).y() - along.y() * (end - a).x());
    return maximum;
}

}  // namespace hairloom
