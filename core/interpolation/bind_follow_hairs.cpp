// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/curve.h"
#include "core/interpolation/follow_hairs.h"
#include "hairloom/follow_recipe.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
constexpr std::uint32_t kMaxFollowPerGuide = 4096;
constexpr float kLargestRadius = 0.1f;

Status checkRange(std::string_view name, float value, float low, float high) {
    if (value >= low && value <= high) return {};
    return fail(fmt::format("{} is {}", name, value), fmt::format("expected {} to {}", low, high));
}

Status checkSettings(const InterpolationSettings& settings, const PartingSettings& parting) {
    if (settings.followPerGuide > kMaxFollowPerGuide) {
        return fail(fmt::format("{} follow hairs per guide", settings.followPerGuide),
                    fmt::format("expected 0 to {}", kMaxFollowPerGuide));
    }
    auto status = checkRange("the wisp radius at the root", settings.wispRadiusRoot, 0, kLargestRadius);
    if (status) status = checkRange("the wisp radius at the tip", settings.wispRadiusTip, 0, kLargestRadius);
    if (status)
        status = checkRange("the spread of wisps by speed", settings.wispSpread, 0, runtime::kMostSpread);
    if (status)
        status = checkRange("the limit of that spread", settings.wispSpreadLimit, 1, runtime::kMostWidening);
    if (status) status = checkRange("the blend", settings.blend, 0, 1);
    if (status) status = checkRange("the angle where a parting begins", parting.beginAngleDegrees, 0, 180);
    if (status &&
        !(parting.endAngleDegrees > parting.beginAngleDegrees && parting.endSpread > parting.beginSpread)) {
        return fail("a parting ends before it begins", "expected end above begin");
    }
    return status;
}

Result<std::vector<std::uint32_t>> findGuides(const Groom& groom) {
    const auto flags = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
    std::vector<std::uint32_t> guides;
    for (std::uint32_t strand = 0; strand < groom.strandCount(); ++strand) {
        if (flags.size() == groom.strandCount() && flags[strand] == 0) continue;
        const std::uint32_t points = groom.offsets[strand + 1] - groom.offsets[strand];
        if (points < 2)
            return fail(fmt::format("guide strand {} has {} points", strand, points), "expected two or more");
        guides.push_back(strand);
    }
    if (guides.empty())
        return fail("the groom has no guides", "expected at least one strand flagged as guide");
    return guides;
}

/// A density that asks for a part of a hair gives one to that share of the guides, by chance.
std::vector<std::uint32_t> hairsOfGuides(const Groom& groom, const InterpolationSettings& settings,
                                         const std::vector<std::uint32_t>& guideStrands) {
    constexpr std::uint64_t kStream = 0xde5;
    const auto layers = groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::vector<std::uint32_t> hairs;
    hairs.reserve(guideStrands.size());
    for (const std::uint32_t strand : guideStrands) {
        const std::uint32_t layer = strand < layers.size() ? layers[strand] : 0;
        const float density = layer < groom.layers.size() ? groom.layers[layer].density : 1.0f;
        const double wanted = double{density} * settings.followPerGuide;
        const std::uint32_t id = strand < ids.size() ? ids[strand] : strand;
        Random random(settings.seed, (kStream << 32u) | id);
        const double rounded = std::floor(wanted + double{random.uniform()});
        hairs.push_back(std::min(static_cast<std::uint32_t>(rounded), kMaxFollowPerGuide));
    }
    return hairs;
}

/// Root triangles whose corners count guides.
std::vector<Triangle> guideTriangles(const Groom& groom, const std::vector<std::uint32_t>& guideStrands) {
    std::vector<std::uint32_t> guideOf(groom.strandCount(), kNone);
    for (std::uint32_t guide = 0; guide < guideStrands.size(); ++guide) guideOf[guideStrands[guide]] = guide;
    if (guideStrands.size() == groom.strandCount() || !groom.scalp) {
        std::vector<Triangle> triangles;
        for (const Triangle& strands : groom.triangulation.triangles) {
            const bool known = std::all_of(strands.begin(), strands.end(),
                                           [&](std::uint32_t s) { return s < guideOf.size(); });
            if (!known) continue;
            const Triangle guides{guideOf[strands[0]], guideOf[strands[1]], guideOf[strands[2]]};
            if (std::find(guides.begin(), guides.end(), kNone) == guides.end()) triangles.push_back(guides);
        }
        if (!triangles.empty()) return triangles;
    }
    const auto bindings = groom.rootBindings();
    if (!groom.scalp || bindings.size() != groom.strandCount()) return {};
    std::vector<SurfacePoint> roots;
    for (const std::uint32_t strand : guideStrands) roots.push_back(bindings[strand]);
    auto triangulation = triangulateRoots(*groom.scalp, groom.scalpSelection, roots);
    // Too few guides for a triangle still make wisps.
    return triangulation ? std::move(triangulation->triangles) : std::vector<Triangle>();
}

runtime::Float3 toFloat3(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

class Binder {
  public:
    Binder(const Groom& groom, const InterpolationSettings& settings, const PartingSettings& parting,
           FollowBindings& bindings)
        : groom_(groom), settings_(settings), parting_(parting), bindings_(bindings) {}

    void run() {
        positions_ = guidePositions(groom_, bindings_);
        const std::size_t guides = bindings_.guideCount();
        roots_.resize(guides);
        lengths_.resize(guides);
        for (std::uint32_t guide = 0; guide < guides; ++guide) {
            roots_[guide] = points(guide).front();
            lengths_[guide] = polylineLength(points(guide));
        }
        setFrames();
        const auto radii =
            runtime::wispRadii(settings_.wispRadiusRoot, settings_.wispRadiusTip, bindings_.pointsPerHair);
        bindings_.radii.assign(radii.begin(), radii.end());
        bindings_.wisps = {settings_.wispSpread, settings_.wispSpreadLimit};
        bindings_.triangles = guideTriangles(groom_, bindings_.guideStrands);
        setHairs();
        projectRoots();
    }

  private:
    std::span<const Vec3f> points(std::uint32_t guide) const {
        return std::span(positions_)
            .subspan(std::size_t{guide} * bindings_.pointsPerHair, bindings_.pointsPerHair);
    }

    /// The frame's third axis is the interpolated scalp normal at the root (thesis §4.2), or the strand's
    /// first direction where there is no scalp.
    void setFrames() {
        const auto rootBindings = groom_.rootBindings();
        const bool bound = groom_.scalp && rootBindings.size() == groom_.strandCount();
        bindings_.rootFrames.resize(bindings_.guideCount());
        for (std::uint32_t guide = 0; guide < bindings_.guideCount(); ++guide) {
            Vec3f normal = points(guide)[1] - points(guide)[0];
            if (bound) {
                const SurfacePoint& root = rootBindings[bindings_.guideStrands[guide]];
                normal = groom_.scalp->normalAt(root.triangle, root.barycentric);
            }
            if (!(normal.norm() > 0)) normal = Vec3f::UnitY();
            normal.normalize();
            const Vec3f axis = normal.unitOrthogonal();
            bindings_.rootFrames[guide] << axis, normal.cross(axis), normal;
        }
    }

    /// The engine draws them, here as in a game.
    void setHairs() {
        const auto stored = groom_.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
        bindings_.ids = bindings_.guideStrands;
        if (stored.size() == groom_.strandCount()) {
            for (std::uint32_t& id : bindings_.ids) id = stored[id];
        }
        for (const auto& [a, b, c] : bindings_.triangles)
            bindings_.areas.push_back((roots_[b] - roots_[a]).cross(roots_[c] - roots_[a]).norm());
        const auto layersOfStrands = groom_.strandAttributes.view<std::uint32_t>(attribute::kLayer);
        std::vector<std::uint32_t> layers;
        std::vector<runtime::Float3> along, roots, quarters, tips;
        for (std::uint32_t guide = 0; guide < bindings_.guideCount(); ++guide) {
            const std::uint32_t strand = bindings_.guideStrands[guide];
            layers.push_back(strand < layersOfStrands.size() ? layersOfStrands[strand] : 0);
            along.clear();
            for (const Vec3f& point : points(guide)) along.push_back(toFloat3(point));
            roots.push_back(along.front());
            quarters.push_back(runtime::pointAtShare(along, runtime::FollowRecipe::kQuarter));
            tips.push_back(along.back());
        }
        runtime::Host host;
        host.parallelFor = parallelFor;
        const runtime::DrawnHairs drawn = runtime::drawFollowHairs(
            {settings_.seed,
             bindings_.hairs,
             settings_.blend,
             settings_.drawGuides,
             {parting_.beginAngleDegrees, parting_.endAngleDegrees, parting_.beginSpread, parting_.endSpread},
             bindings_.ids,
             layers,
             roots,
             quarters,
             tips,
             lengths_,
             bindings_.triangles,
             bindings_.areas},
            host);
        bindings_.guides.assign(drawn.guides.begin(), drawn.guides.end());
        bindings_.blends.assign(drawn.blends.begin(), drawn.blends.end());
        for (std::size_t hair = 0; hair < drawn.guides.size(); ++hair) {
            const runtime::Float3 &shares = drawn.weights[hair], &root = drawn.rootWeights[hair];
            bindings_.weights.emplace_back(shares.x, shares.y, shares.z);
            bindings_.rootWeights.emplace_back(root.x, root.y, root.z);
            bindings_.wispOffsets.emplace_back(drawn.wispOffsets[hair][0], drawn.wispOffsets[hair][1]);
        }
        bindings_.rootShifts.assign(drawn.guides.size(), Vec3f::Zero());
    }

    void projectRoots() {
        if (!groom_.scalp || groom_.scalp->triangleCount() == 0) return;
        const SurfaceTree tree(*groom_.scalp, groom_.scalpSelection);
        bindings_.roots.resize(bindings_.hairCount());
        parallelFor(bindings_.hairCount(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t hair = begin; hair < end; ++hair) {
                const Vec3f root = restRoot(hair);
                const auto hit = tree.closest(root);
                const Mat3f& frame = bindings_.rootFrames[bindings_.guides[hair][0]];
                bindings_.roots[hair] = hit.surface;
                bindings_.rootShifts[hair] = frame.transpose() * (hit.position - root);
            }
        });
    }

    Vec3f restRoot(std::size_t hair) const {
        const auto& guides = bindings_.guides[hair];
        const Mat3f& frame = bindings_.rootFrames[guides[0]];
        const Vec2f offset = bindings_.wispOffsets[hair] * bindings_.radii[0];
        const Vec3f wisp = roots_[guides[0]] + frame.leftCols<2>() * offset;
        Vec3f between = Vec3f::Zero();
        for (int k = 0; k < 3; ++k)
            between += bindings_.rootWeights[hair][k] * roots_[guides[static_cast<std::size_t>(k)]];
        return wisp + bindings_.blends[hair] * (between - wisp);
    }

    const Groom& groom_;
    const InterpolationSettings& settings_;
    const PartingSettings& parting_;
    FollowBindings& bindings_;
    std::vector<Vec3f> positions_;
    std::vector<Vec3f> roots_;
    std::vector<float> lengths_;
};

}  // namespace

Result<FollowBindings> bindFollowHairs(const Groom& groom, const InterpolationSettings& settings,
                                       const PartingSettings& parting) {
    if (auto status = checkSettings(settings, parting); !status) return tl::unexpected(status.error());
    auto guides = findGuides(groom);
    if (!guides) return tl::unexpected(guides.error());
    FollowBindings bindings;
    bindings.guideStrands = std::move(*guides);
    bindings.hairs = hairsOfGuides(groom, settings, bindings.guideStrands);
    for (const std::uint32_t strand : bindings.guideStrands) {
        bindings.pointsPerHair =
            std::max(bindings.pointsPerHair, groom.offsets[strand + 1] - groom.offsets[strand]);
    }
    Binder(groom, settings, parting, bindings).run();
    return bindings;
}

std::vector<Vec3f> guidePositions(const Groom& groom, const FollowBindings& bindings) {
    const std::size_t points = bindings.pointsPerHair;
    std::vector<Vec3f> positions(bindings.guideCount() * points);
    parallelFor(bindings.guideCount(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t guide = begin; guide < end; ++guide) {
            const auto strand = groom.strand(bindings.guideStrands[guide]);
            const auto target = positions.begin() + static_cast<std::ptrdiff_t>(guide * points);
            if (strand.size() == points) {
                std::copy(strand.begin(), strand.end(), target);
            } else {
                const auto resampled = resampleEvenly(strand, points);
                std::copy(resampled.begin(), resampled.end(), target);
            }
        }
    });
    return positions;
}

}  // namespace hairloom
