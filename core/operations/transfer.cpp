// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/curve.h"
#include "core/groom/poses.h"
#include "core/operations/strand_edit.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 256;
constexpr std::size_t kFitted = 2000;  ///< places of the scalp that the fit looks at, at most
constexpr int kRounds = 60;
constexpr float kClearance = 0.0005f;  ///< metres

Vec3f apply(const HeadFit& fit, const Vec3f& point) {
    return fit.scale * point + fit.shift;
}

/// The scale and shift that bring `from` nearest to `to`, in the sense of least squares.
HeadFit leastSquares(std::span<const Vec3f> from, std::span<const Vec3f> to) {
    Vec3d meanFrom = Vec3d::Zero(), meanTo = Vec3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        meanFrom += from[i].cast<double>();
        meanTo += to[i].cast<double>();
    }
    meanFrom /= static_cast<double>(from.size());
    meanTo /= static_cast<double>(from.size());
    double both = 0, own = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3d a = from[i].cast<double>() - meanFrom;
        both += a.dot(to[i].cast<double>() - meanTo);
        own += a.squaredNorm();
    }
    HeadFit fit;
    fit.scale = std::clamp(own > 0 ? static_cast<float>(both / own) : 1.0f, kMinHeadScale, kMaxHeadScale);
    fit.shift = (meanTo - static_cast<double>(fit.scale) * meanFrom).cast<float>();
    return fit;
}

PlacesFit fitFrom(float scale, std::span<const Vec3f> places, const Vec3f& crown, const SurfaceTree& tree,
                  const Vec3f& crownThere) {
    PlacesFit fitted{{scale, crownThere - scale * crown}, 0};
    std::vector<Vec3f> nearest(places.size());
    for (int round = 0; round < kRounds; ++round) {
        parallelFor(places.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                nearest[i] = tree.closest(apply(fitted.fit, places[i])).position;
        });
        fitted.fit = leastSquares(places, nearest);
    }
    for (std::size_t i = 0; i < places.size(); ++i)
        fitted.off += static_cast<double>((apply(fitted.fit, places[i]) - nearest[i]).norm());
    fitted.off /= static_cast<double>(places.size()) * static_cast<double>(fitted.fit.scale);
    return fitted;
}

HeadFit fitHeads(const Groom& groom, const SurfaceTree& tree, const ScalpMesh& head) {
    std::vector<Vec3f> places;
    const std::size_t step = std::max<std::size_t>(1, groom.strandCount() / kFitted);
    for (std::size_t s = 0; s < groom.strandCount(); s += step) places.push_back(groom.strand(s)[0]);
    return fitPlaces(places, crownOf(*groom.scalp), tree, crownOf(head)).fit;
}

/// Faces of the new head that lie where faces of the old selection do.
FaceSet carriedSelection(const Groom& groom, const HeadFit& fit, const ScalpMesh& head,
                         const WorkWatch& watch) {
    constexpr float kBeside = 0.02f;  // metres on the old head
    std::vector<bool> selected(groom.scalp->triangleCount(), false);
    for (const std::uint32_t face : groom.scalpSelection) selected[face] = true;
    const SurfaceTree old(*groom.scalp);
    std::vector<std::uint8_t> carried(head.triangleCount(), 0);
    parallelFor(carried.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end && !watch.isCancelled(); ++t) {
            const Triangle& corners = head.triangles()[t];
            const Vec3f centre =
                (head.positions()[corners[0]] + head.positions()[corners[1]] + head.positions()[corners[2]]) /
                3;
            const auto hit = old.closest((centre - fit.shift) / fit.scale);
            carried[t] = hit.distance < kBeside && selected[hit.surface.triangle] ? 1 : 0;
        }
    });
    FaceSet faces;
    for (std::uint32_t t = 0; t < carried.size(); ++t) {
        if (carried[t] != 0) faces.push_back(t);
    }
    return faces;
}

/// Strands at their new roots, turned by the least turn that takes the old skin's normal to the new one's.
std::vector<Vec3f> movedPoints(const Groom& groom, const HeadFit& fit, const ScalpMesh& head,
                               std::span<const SurfacePoint> from, std::span<const SurfacePoint> to) {
    const auto before = groom.positions();
    std::vector<Vec3f> points(before.begin(), before.end());
    parallelFor(groom.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Vec3f root = groom.strand(s)[0];
            const Quatf turn = shortestArc(groom.scalp->normalAt(from[s].triangle, from[s].barycentric),
                                           head.normalAt(to[s].triangle, to[s].barycentric));
            const Vec3f place = head.pointAt(to[s].triangle, to[s].barycentric);
            for (std::uint32_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p)
                points[p] = place + fit.scale * (turn * Vec3f(points[p] - root));
        }
    });
    return points;
}

}  // namespace

Vec3f crownOf(const ScalpMesh& mesh) {
    const Box3f bounds = mesh.bounds();
    const float floor = bounds.max().y() - 0.05f * bounds.sizes().y();
    Vec3f sum = Vec3f::Zero();
    float count = 0;
    for (const Vec3f& position : mesh.positions()) {
        if (position.y() < floor) continue;
        sum += position;
        count += 1;
    }
    return {sum.x() / count, bounds.max().y(), sum.z() / count};
}

PlacesFit fitPlaces(std::span<const Vec3f> places, const Vec3f& crown, const SurfaceTree& tree,
                    const Vec3f& crownThere) {
    PlacesFit best;
    best.off = std::numeric_limits<double>::infinity();
    for (const float scale : {1.0f, 0.6f, 1.6f}) {
        const PlacesFit fitted = fitFrom(scale, places, crown, tree, crownThere);
        if (fitted.off < 0.999 * best.off) best = fitted;
    }
    return best;
}

Result<Transfer> transferTo(Groom& target, std::shared_ptr<const ScalpMesh> head, const WorkWatch& watch) {
    Groom groom = target;
    const std::vector<SurfacePoint> from = groom.rootBindings();
    if (!groom.scalp || from.size() != groom.strandCount() || from.empty())
        return fail("the strands are not bound to a head", "expected hair that grows on one");
    if (!head || head->triangleCount() == 0)
        return fail("the head has no triangles", "expected a mesh with faces");
    Transfer transfer;
    const SurfaceTree tree(*head);
    if (auto status = watch.at(0); !status) return tl::unexpected(status.error());
    transfer.fit = fitHeads(groom, tree, *head);
    if (auto status = watch.at(0.2); !status) return tl::unexpected(status.error());
    transfer.sameMesh = std::ranges::equal(groom.scalp->triangles(), head->triangles());
    std::vector<SurfacePoint> to(from.begin(), from.end());
    transfer.distances.resize(to.size());
    std::vector<Vec2f> uvs(to.size());
    parallelFor(to.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end && !watch.isCancelled(); ++s) {
            const SurfaceTree::Hit hit = tree.closest(apply(transfer.fit, groom.strand(s)[0]));
            if (!transfer.sameMesh) {
                transfer.distances[s] = hit.distance;
                to[s] = hit.surface;
            }
            uvs[s] = head->uvAt(to[s].triangle, to[s].barycentric);
        }
    });
    if (auto status = watch.at(0.4); !status) return tl::unexpected(status.error());
    transfer.baked = !groom.operators.empty();
    dropOperators(groom);
    FaceSet selection =
        transfer.sameMesh ? groom.scalpSelection : carriedSelection(groom, transfer.fit, *head, watch);
    if (auto status = watch.at(0.5); !status) return tl::unexpected(status.error());
    for (const SurfacePoint& root : to) selection.push_back(root.triangle);
    std::ranges::sort(selection);
    selection.erase(std::unique(selection.begin(), selection.end()), selection.end());
    for (const GroomPose& pose : groom.poses) {
        const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(pose.name));
        if (shape.size() != groom.pointCount()) continue;
        Groom posed = groom;
        posed.pointAttributes.set(attribute::kPosition, std::vector<Vec3f>(shape.begin(), shape.end()));
        groom.pointAttributes.set(poseAttribute(pose.name),
                                  movedPoints(posed, transfer.fit, *head, from, to));
    }
    groom.pointAttributes.set(attribute::kPosition, movedPoints(groom, transfer.fit, *head, from, to));
    groom.strandAttributes.set(attribute::kRootUv, std::move(uvs));
    for (CollisionSphere& sphere : groom.spheres) {
        sphere.centre = apply(transfer.fit, sphere.centre);
        sphere.radius *= transfer.fit.scale;
    }
    groom.setRootBindings(to);
    groom.triangulation = {};
    groom.scalpDensity.clear();
    groom.scalpExpression.clear();
    groom.scalpSelection = std::move(selection);
    groom.characterFile.clear();
    groom.characterMetresPerUnit = 0;
    groom.scalp = std::move(head);
    groom.body.reset();
    if (auto status = watch.at(0.6); !status) return tl::unexpected(status.error());
    editStrands(groom, {}, {.clearance = kClearance, .cancelled = watch.cancelled}, [](StrandEdit&) {});
    if (auto status = watch.at(1); !status) return tl::unexpected(status.error());
    target = std::move(groom);
    return transfer;
}

}  // namespace hairloom
