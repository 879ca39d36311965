// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/strand_maker.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/base/parallel.h"
#include "core/editing/zero.h"
#include "core/geometry/curve.h"
#include "core/groom/poses.h"
#include "core/operations/length_constraint.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 64;
constexpr std::size_t kNeighbours = 3;

using Neighbours = std::vector<RootGrid::Neighbour>;

/// The strand with another number of points, evenly spaced.
std::vector<Vec3f> withCount(std::span<const Vec3f> points, std::size_t count) {
    if (points.size() == count) return {points.begin(), points.end()};
    return resampleEvenly(points, count);
}

/// The mean of the neighbours, each turned so that its root's normal becomes the new one's.
void blend(const Groom& groom, const Neighbours& neighbours, const SurfacePoint& root,
           std::span<Vec3f> points) {
    const auto triangles = groom.strandAttributes.view<std::uint32_t>(attribute::kRootTriangle);
    const auto barycentrics = groom.strandAttributes.view<Vec3f>(attribute::kRootBarycentric);
    const Vec3f normal = groom.scalp->normalAt(root.triangle, root.barycentric);
    const Vec3f start = groom.scalp->pointAt(root.triangle, root.barycentric);
    std::fill(points.begin(), points.end(), Vec3f::Zero());
    constexpr float kNear = 1e-5f;  // metres; nearer neighbours do not count any more
    float sum = 0;
    for (const RootGrid::Neighbour& neighbour : neighbours) {
        const float weight = 1 / std::max(neighbour.distance, kNear);
        const std::uint32_t s = neighbour.strand;
        const bool bound = s < triangles.size() && s < barycentrics.size();
        const Vec3f from = bound ? groom.scalp->normalAt(triangles[s], barycentrics[s]) : normal;
        const Mat3f turn = shortestArc(from, normal).toRotationMatrix();
        const std::vector<Vec3f> guide = withCount(groom.strand(s), points.size());
        for (std::size_t p = 1; p < points.size(); ++p) points[p] += weight * (turn * (guide[p] - guide[0]));
        sum += weight;
    }
    for (Vec3f& point : points) point = start + point / sum;
}

/// Mean of the segments' lengths, so that the mean of strands that point apart is not shorter than they are.
void keepLengths(const Groom& groom, const Neighbours& neighbours, std::span<Vec3f> points) {
    double length = 0;
    for (const RootGrid::Neighbour& neighbour : neighbours)
        length += static_cast<double>(polylineLength(groom.strand(neighbour.strand)));
    const auto each =
        static_cast<float>(length / static_cast<double>(neighbours.size() * (points.size() - 1)));
    const std::vector<float> lengths(points.size() - 1, each);
    restoreLengthsByDirection(points, lengths);
}

void growStraight(const Groom& groom, const SurfacePoint& root, std::span<Vec3f> points) {
    const Vec3f start = groom.scalp->pointAt(root.triangle, root.barycentric);
    const Vec3f along = groom.scalp->normalAt(root.triangle, root.barycentric) * groom.placement.length;
    for (std::size_t p = 0; p < points.size(); ++p)
        points[p] = start + along * (static_cast<float>(p) / static_cast<float>(points.size() - 1));
}

/// What the maker needs of each new strand.
struct Plan {
    std::vector<Neighbours> neighbours;
    std::vector<std::uint32_t> offsets{0};
    std::size_t count() const { return neighbours.size(); }
    std::size_t pointCount() const { return offsets.back(); }
};

Plan planOf(const Groom& groom, const RootGrid& grid, std::span<const SurfacePoint> roots, float reach) {
    Plan plan;
    plan.neighbours.resize(roots.size());
    parallelFor(roots.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end && reach > 0; ++r) {
            const Vec3f root = groom.scalp->pointAt(roots[r].triangle, roots[r].barycentric);
            plan.neighbours[r] = grid.nearest(root, kNeighbours, reach);
        }
    });
    for (const Neighbours& near : plan.neighbours) {
        const std::uint32_t points = near.empty()
                                         ? groom.placement.points
                                         : groom.offsets[near[0].strand + 1] - groom.offsets[near[0].strand];
        plan.offsets.push_back(plan.offsets.back() + points);
    }
    return plan;
}

AttributeSet inheritedStrandData(const Groom& groom, const Plan& plan) {
    AttributeSet data;
    for (const auto& [name, array] : groom.strandAttributes.all()) {
        std::visit(
            [&, &attributeName = name]<class T>(const CowArray<T>& values) {
                std::vector<T> inherited(plan.count(), zero<T>());
                for (std::size_t k = 0; k < plan.count(); ++k) {
                    if (!plan.neighbours[k].empty()) inherited[k] = values[plan.neighbours[k][0].strand];
                }
                data.set(attributeName, std::move(inherited));
            },
            array);
    }
    return data;
}

/// Strands without neighbours have the pigment of their material and the stiffness of the settings: none at
/// all would be white, and limp.
void setFactors(const Plan& plan, AttributeSet& data) {
    for (const std::string_view name : {attribute::kMelanin, attribute::kStiffness}) {
        if (!data.has(name)) continue;
        std::vector<float>& factors = data.edit<float>(name);
        factors.resize(plan.count(), 1);
        for (std::size_t k = 0; k < plan.count(); ++k) {
            if (plan.neighbours[k].empty()) factors[k] = 1;
        }
    }
}

AttributeSet inheritedPointData(const Groom& groom, const Plan& plan) {
    AttributeSet data;
    for (const auto& [name, array] : groom.pointAttributes.all()) {
        std::visit(
            [&, &attributeName = name]<class T>(const CowArray<T>& values) {
                std::vector<T> inherited(plan.pointCount(), zero<T>());
                // Poses of before do not know them.
                const bool isPose = attributeName.starts_with(kPosePrefix);
                for (std::size_t k = 0; k < plan.count() && !isPose; ++k) {
                    if (plan.neighbours[k].empty()) continue;
                    const auto from = values.view().subspan(groom.offsets[plan.neighbours[k][0].strand],
                                                            plan.offsets[k + 1] - plan.offsets[k]);
                    std::copy(from.begin(), from.end(),
                              inherited.begin() + static_cast<std::ptrdiff_t>(plan.offsets[k]));
                }
                data.set(attributeName, std::move(inherited));
            },
            array);
    }
    return data;
}

void taper(const Groom& groom, const Plan& plan, AttributeSet& data) {
    const bool wanted = groom.strandCount() == 0 || groom.pointAttributes.has(attribute::kRadius);
    if (!wanted) return;
    std::vector<float>& radii = data.edit<float>(attribute::kRadius);
    radii.resize(plan.pointCount(), 0);
    const HairMaterial& material = groom.material;
    for (std::size_t k = 0; k < plan.count(); ++k) {
        if (!plan.neighbours[k].empty()) continue;
        const std::size_t first = plan.offsets[k];
        const std::size_t count = plan.offsets[k + 1] - first;
        for (std::size_t p = 0; p < count; ++p) {
            const float t = static_cast<float>(p) / static_cast<float>(count - 1);
            radii[first + p] = material.rootRadius * (1.0f + t * (material.tipScale - 1.0f));
        }
    }
}

void bindRoots(const Groom& groom, std::span<const SurfacePoint> roots, AttributeSet& data) {
    std::vector<std::uint32_t> triangles(roots.size());
    std::vector<Vec3f> barycentrics(roots.size());
    std::vector<Vec2f> uvs(roots.size());
    for (std::size_t r = 0; r < roots.size(); ++r) {
        triangles[r] = roots[r].triangle;
        barycentrics[r] = roots[r].barycentric;
        uvs[r] = groom.scalp->uvAt(roots[r].triangle, roots[r].barycentric);
    }
    data.set(attribute::kRootTriangle, std::move(triangles));
    data.set(attribute::kRootBarycentric, std::move(barycentrics));
    data.set(attribute::kRootUv, std::move(uvs));
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    const std::uint32_t next = ids.empty() ? static_cast<std::uint32_t>(groom.strandCount())
                                           : *std::max_element(ids.begin(), ids.end()) + 1;
    std::vector<std::uint32_t> fresh(roots.size());
    std::iota(fresh.begin(), fresh.end(), next);
    data.set(attribute::kStrandId, std::move(fresh));
    for (const std::string_view flag : {attribute::kFrozen, attribute::kHidden}) {
        if (data.has(flag)) data.set(flag, std::vector<std::uint8_t>(roots.size(), 0));
    }
}

/// Operators act on new strands as on those beside them, so that these are made from the base shapes.
TakenStrands makeBelowStack(const Groom& groom, const RootGrid& grid, std::span<const SurfacePoint> roots,
                            float reach, const KeepOut& skin) {
    Groom base = groom;
    base.operators.clear();
    // Hair that was saved without a strand may have none.
    const auto shape = groom.pointAttributes.all().find(attribute::kBasePosition);
    if (shape != groom.pointAttributes.all().end())
        base.pointAttributes.set(attribute::kPosition, shape->second);
    TakenStrands strands = makeStrands(base, grid, roots, reach, skin);
    strands.pointData.set(attribute::kBasePosition,
                          strands.pointData.all().find(attribute::kPosition)->second);
    return strands;
}

}  // namespace

RootGrid gridOfRoots(const Groom& groom, float cell) {
    RootGrid grid(cell);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto points = groom.strand(s);
        if (points.size() >= 2) grid.add(static_cast<std::uint32_t>(s), points[0]);
    }
    return grid;
}

TakenStrands makeStrands(const Groom& groom, const RootGrid& grid, std::span<const SurfacePoint> roots,
                         float reach, const KeepOut& skin) {
    if (!groom.operators.empty()) return makeBelowStack(groom, grid, roots, reach, skin);
    const Plan plan = planOf(groom, grid, roots, reach);
    TakenStrands strands;
    strands.indices.resize(roots.size());
    std::iota(strands.indices.begin(), strands.indices.end(),
              static_cast<std::uint32_t>(groom.strandCount()));
    for (std::size_t k = 0; k < plan.count(); ++k)
        strands.counts.push_back(plan.offsets[k + 1] - plan.offsets[k]);
    strands.strandData = inheritedStrandData(groom, plan);
    strands.pointData = inheritedPointData(groom, plan);
    std::vector<Vec3f> positions(plan.pointCount());
    parallelFor(plan.count(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        for (std::size_t k = begin; k < end; ++k) {
            const auto points = std::span(positions).subspan(plan.offsets[k], strands.counts[k]);
            if (plan.neighbours[k].empty()) {
                growStraight(groom, roots[k], points);
            } else {
                blend(groom, plan.neighbours[k], roots[k], points);
                keepLengths(groom, plan.neighbours[k], points);
            }
            if (!skin.query) continue;
            measureSegments(points, lengths);
            keepOutside(points, lengths, *skin.query, skin.clearance);
        }
    });
    strands.pointData.set(attribute::kPosition, std::move(positions));
    taper(groom, plan, strands.pointData);
    bindRoots(groom, roots, strands.strandData);
    setFactors(plan, strands.strandData);
    return strands;
}

}  // namespace hairloom::editing
