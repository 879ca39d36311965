// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/region_select.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 256;
constexpr float kCover = 0.001f;  ///< metres by which a thing must lie behind the skin to be covered

bool isCovered(const SurfaceTree* surface, const View& view, const ScreenPoint& seen) {
    const auto head = pickHead(surface, view, seen.px);
    if (!head) return false;
    const auto front = view.project(head->position);
    return front && front->depth < seen.depth - kCover;
}

/// Ascending indices below `count` that `test` accepts.
template <class Test>
std::vector<std::uint32_t> indicesWhere(std::size_t count, Test test) {
    std::vector<std::uint8_t> accepted(count, 0);
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) accepted[i] = test(i) ? 1 : 0;
    });
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < count; ++i) {
        if (accepted[i]) indices.push_back(static_cast<std::uint32_t>(i));
    }
    return indices;
}

}  // namespace

ScreenRegion ScreenRegion::box(const Vec2f& a_px, const Vec2f& b_px) {
    return lasso({a_px, Vec2f(b_px.x(), a_px.y()), b_px, Vec2f(a_px.x(), b_px.y())});
}

ScreenRegion ScreenRegion::lasso(std::vector<Vec2f> corners_px) {
    ScreenRegion region;
    region.corners_ = std::move(corners_px);
    if (region.corners_.empty()) return region;
    region.low_ = region.high_ = region.corners_.front();
    for (const Vec2f& corner : region.corners_) {
        region.low_ = region.low_.cwiseMin(corner);
        region.high_ = region.high_.cwiseMax(corner);
    }
    return region;
}

bool ScreenRegion::contains(const Vec2f& px) const {
    if ((px.array() < low_.array()).any() || (px.array() > high_.array()).any()) return false;
    bool inside = false;
    for (std::size_t i = 0, j = corners_.size() - 1; i < corners_.size(); j = i++) {
        const Vec2f& a = corners_[i];
        const Vec2f& b = corners_[j];
        if ((a.y() > px.y()) == (b.y() > px.y())) continue;
        if (px.x() < a.x() + (px.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
}

std::vector<std::uint32_t> strandsIn(const ScreenRegion& region, const Groom& groom,
                                     const SurfaceTree* surface, const View& view,
                                     const RegionOptions& options) {
    const std::vector<std::uint8_t> shown = shownStrands(groom);
    const auto isInside = [&](const Vec3f& point) {
        const auto seen = view.project(point);
        return seen && region.contains(seen->px) && (options.throughHead || !isCovered(surface, view, *seen));
    };
    return indicesWhere(groom.strandCount(), [&](std::size_t s) {
        const auto points = groom.strand(s);
        if (!shown[s] || points.empty()) return false;
        if (options.part == StrandPart::Root) return isInside(points.front());
        if (options.part == StrandPart::Tip) return isInside(points.back());
        return std::any_of(points.begin(), points.end(), isInside);
    });
}

FaceSet facesIn(const ScreenRegion& region, const ScalpMesh& mesh, const SurfaceTree& surface,
                const View& view, bool throughHead) {
    return indicesWhere(mesh.triangleCount(), [&](std::size_t i) {
        const auto face = static_cast<std::uint32_t>(i);
        const auto seen = view.project(mesh.pointAt(face, Vec3f::Constant(1.0f / 3)));
        if (!seen || !region.contains(seen->px)) return false;
        if (throughHead) return true;
        const Vec3f towards = view.rayAt(seen->px).direction_ss;
        return mesh.triangleNormal(face).dot(towards) < 0 && !isCovered(&surface, view, *seen);
    });
}

}  // namespace hairloom::editing
