// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/flat_chart.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hairloom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Segment_2 toCgal(const SegmentGrid::Segment& s) {
    return {Kernel::Point_2(s[0].x(), s[0].y()), Kernel::Point_2(s[1].x(), s[1].y())};
}

double angleBetween(const Vec2d& a, const Vec2d& b) {
    return std::atan2(std::abs(a.x() * b.y() - a.y() * b.x()), a.dot(b));
}

bool facesArePositive(std::span<const Vec2d> uvs) {
    for (std::size_t c = 0; c < uvs.size(); c += 3) {
        const auto point = [&](std::size_t i) { return Kernel::Point_2(uvs[c + i].x(), uvs[c + i].y()); };
        if (!uvs[c].allFinite() || !uvs[c + 1].allFinite() || !uvs[c + 2].allFinite()) return false;
        if (CGAL::orientation(point(0), point(1), point(2)) != CGAL::LEFT_TURN) return false;
    }
    return true;
}

constexpr std::uint32_t nextSide(std::uint32_t side) {
    return side % 3 == 2 ? side - 2 : side + 1;
}
constexpr std::uint32_t previousSide(std::uint32_t side) {
    return side % 3 == 0 ? side + 2 : side - 1;
}

/// Walks round the corner's vertex once; false when a closed fan turns more than one full angle.
bool windsOnce(std::span<const std::uint32_t> opposite, std::span<const Vec2d> uvs, std::uint32_t corner) {
    double angle = 0;
    std::uint32_t at = corner;
    do {
        const Vec2d a = uvs[nextSide(at)] - uvs[at];
        const Vec2d b = uvs[previousSide(at)] - uvs[at];
        angle += angleBetween(a, b);
        const std::uint32_t across = opposite[previousSide(at)];
        if (across == kOpenSide) return true;
        at = across;
    } while (at != corner);
    return angle < 3 * std::numbers::pi;
}

/// Border segments may share end points and nothing else.
bool borderIsSimple(std::span<const std::uint32_t> opposite, std::span<const Vec2d> uvs) {
    const SegmentGrid grid(flatBorder(opposite, uvs));
    std::vector<std::uint32_t> found;
    for (std::uint32_t s = 0; s < grid.segments().size(); ++s) {
        const SegmentGrid::Segment& a = grid.segments()[s];
        grid.near(a[0].cwiseMin(a[1]), a[0].cwiseMax(a[1]), found);
        for (const std::uint32_t other : found) {
            if (other <= s) continue;
            const SegmentGrid::Segment& b = grid.segments()[other];
            const bool joined = a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
            if (!joined && CGAL::do_intersect(toCgal(a), toCgal(b))) return false;
        }
    }
    return true;
}

}  // namespace

SegmentGrid::SegmentGrid(std::vector<Segment> segments) : segments_(std::move(segments)) {
    if (segments_.empty()) {
        cells_.resize(1);
        return;
    }
    Eigen::AlignedBox2d box;
    for (const Segment& s : segments_) box.extend(s[0]).extend(s[1]);
    low_ = box.min();
    const double wanted = std::sqrt(static_cast<double>(segments_.size())) + 1;
    perCell_ = wanted / std::max(box.sizes().maxCoeff(), std::numeric_limits<double>::min() * 1e16);
    columns_ = static_cast<std::size_t>(box.sizes().x() * perCell_) + 1;
    rows_ = static_cast<std::size_t>(box.sizes().y() * perCell_) + 1;
    cells_.resize(columns_ * rows_);
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
        const auto [x0, y0] = cellOf(segments_[s][0].cwiseMin(segments_[s][1]));
        const auto [x1, y1] = cellOf(segments_[s][0].cwiseMax(segments_[s][1]));
        for (std::size_t y = y0; y <= y1; ++y)
            for (std::size_t x = x0; x <= x1; ++x) cells_[y * columns_ + x].push_back(s);
    }
}

std::array<std::size_t, 2> SegmentGrid::cellOf(const Vec2d& p) const {
    const auto cell = [&](double offset, std::size_t count) {
        return static_cast<std::size_t>(std::clamp(offset * perCell_, 0.0, static_cast<double>(count - 1)));
    };
    return {cell(p.x() - low_.x(), columns_), cell(p.y() - low_.y(), rows_)};
}

void SegmentGrid::near(const Vec2d& low, const Vec2d& high, std::vector<std::uint32_t>& found) const {
    found.clear();
    const auto [x0, y0] = cellOf(low);
    const auto [x1, y1] = cellOf(high);
    for (std::size_t y = y0; y <= y1; ++y)
        for (std::size_t x = x0; x <= x1; ++x)
            found.insert(found.end(), cells_[y * columns_ + x].begin(), cells_[y * columns_ + x].end());
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

std::vector<SegmentGrid::Segment> flatBorder(std::span<const std::uint32_t> opposite,
                                             std::span<const Vec2d> cornerUvs) {
    std::vector<SegmentGrid::Segment> border;
    for (std::uint32_t side = 0; side < opposite.size(); ++side) {
        const std::uint32_t end = side % 3 == 2 ? side - 2 : side + 1;
        // A side is also open where the chart is cut: the faces across it lie elsewhere in the plane.
        const std::uint32_t across = opposite[side];
        const bool joined = across != kOpenSide && cornerUvs[across] == cornerUvs[end] &&
                            cornerUvs[across % 3 == 2 ? across - 2 : across + 1] == cornerUvs[side];
        if (!joined) border.push_back({cornerUvs[side], cornerUvs[end]});
    }
    return border;
}

bool isInjective(std::span<const std::uint32_t> opposite, std::span<const Vec2d> cornerUvs) {
    if (!facesArePositive(cornerUvs)) return false;
    for (std::uint32_t corner = 0; corner < opposite.size(); ++corner)
        if (!windsOnce(opposite, cornerUvs, corner)) return false;
    return borderIsSimple(opposite, cornerUvs);
}

double meanStretch(const ScalpMesh& mesh, const FaceSet& faces, std::span<const Vec2d> cornerUvs) {
    double sum = 0, area = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Triangle& t = mesh.triangles()[faces[f]];
        const auto place = [&](std::size_t i) -> Vec3d { return mesh.positions()[t[i]].cast<double>(); };
        const Vec3d ab = place(1) - place(0), ac = place(2) - place(0);
        const Vec3d x = ab.normalized(), y = ab.cross(ac).cross(ab).normalized();
        Eigen::Matrix2d surface, flat;
        surface << ab.dot(x), ac.dot(x), ab.dot(y), ac.dot(y);
        flat.col(0) = cornerUvs[3 * f + 1] - cornerUvs[3 * f];
        flat.col(1) = cornerUvs[3 * f + 2] - cornerUvs[3 * f];
        const Eigen::Vector2d sigma = (flat * surface.inverse()).jacobiSvd().singularValues();
        const double weight = mesh.triangleArea(faces[f]);
        sum += weight * sigma[0] / sigma[1];
        area += weight;
    }
    return sum / area;
}

}  // namespace hairloom
