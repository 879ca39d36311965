// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/curve.h"
#include "core/interpolation/follow_hairs.h"

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
        return fail(fmt::format("{} follow hairs for each guide", settings.followPerGuide),
                    fmt::format("expected 0 to {}", kMaxFollowPerGuide));
    }
    auto status = checkRange("the wisp radius at the root", settings.wispRadiusRoot, 0, kLargestRadius);
    if (status) status = checkRange("the wisp radius at the tip", settings.wispRadiusTip, 0, kLargestRadius);
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

/// The triangles around each guide, with the running sum of their areas for drawing by area.
struct Fans {
    std::vector<std::uint32_t> offsets;  ///< per guide, into the others
    std::vector<std::uint32_t> triangles;
    std::vector<float> areas;  ///< running sum within the fan

    Fans(std::size_t guides, const std::vector<Triangle>& all, std::span<const Vec3f> roots)
        : offsets(guides + 1, 0) {
        for (const Triangle& triangle : all) {
            for (const std::uint32_t corner : triangle) ++offsets[corner + 1];
        }
        std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
        triangles.resize(offsets.back());
        areas.resize(offsets.back());
        std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
        for (std::uint32_t index = 0; index < all.size(); ++index) {
            const auto& [a, b, c] = all[index];
            const float area = (roots[b] - roots[a]).cross(roots[c] - roots[a]).norm();
            for (const std::uint32_t corner : all[index]) {
                const std::uint32_t place = next[corner]++;
                triangles[place] = index;
                areas[place] = (place > offsets[corner] ? areas[place - 1] : 0.0f) + area;
            }
        }
    }

    std::uint32_t draw(std::uint32_t guide, float uniform) const {
        const auto begin = areas.begin() + offsets[guide];
        const auto end = areas.begin() + offsets[guide + 1];
        if (begin == end) return kNone;
        const auto found = std::upper_bound(begin, end, uniform * *(end - 1));
        return triangles[static_cast<std::size_t>(std::min(found, end - 1) - areas.begin())];
    }
};

/// Uniform over the part of the triangle where the first corner has the largest weight: the three parts are
/// equally large, and exchanging weights maps one onto another.
Vec3f drawOwnThird(Random& random) {
    float u = random.uniform();
    float v = random.uniform();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    Vec3f weights(1 - u - v, u, v);
    int largest = 0;
    weights.maxCoeff(&largest);
    std::swap(weights[0], weights[largest]);
    return weights;
}

Vec2f drawInDisc(Random& random) {
    const float radius = std::sqrt(random.uniform());
    const float angle = random.uniform(0.0f, 2.0f * kPi);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

float fade(float value, float begin, float end) {
    const float t = std::clamp((value - begin) / (end - begin), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
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
        setRadii();
        triangles_ = guideTriangles(groom_, bindings_.guideStrands);
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

    void setRadii() {
        bindings_.radii.resize(bindings_.pointsPerHair);
        for (std::uint32_t i = 0; i < bindings_.pointsPerHair; ++i) {
            const float s = static_cast<float>(i) / static_cast<float>(bindings_.pointsPerHair - 1);
            bindings_.radii[i] =
                settings_.wispRadiusRoot + s * (settings_.wispRadiusTip - settings_.wispRadiusRoot);
        }
    }

    void setHairs() {
        const std::size_t hairs = bindings_.guideCount() * bindings_.followPerGuide;
        bindings_.guides.resize(hairs);
        bindings_.weights.resize(hairs);
        bindings_.rootWeights.resize(hairs);
        bindings_.wispOffsets.resize(hairs);
        bindings_.blends.resize(hairs);
        bindings_.rootShifts.assign(hairs, Vec3f::Zero());
        if (hairs == 0) return;
        const Fans fans(bindings_.guideCount(), triangles_, roots_);
        const auto ids = groom_.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
        parallelFor(bindings_.guideCount(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t guide = begin; guide < end; ++guide) {
                const std::uint32_t strand = bindings_.guideStrands[guide];
                const std::uint64_t id = ids.size() == groom_.strandCount() ? ids[strand] : strand;
                for (std::uint32_t number = 0; number < bindings_.followPerGuide; ++number) {
                    Random random(settings_.seed, (id << 16u) | number);
                    setHair(static_cast<std::uint32_t>(guide), number, fans, random);
                }
            }
        });
    }

    void setHair(std::uint32_t guide, std::uint32_t number, const Fans& fans, Random& random) {
        const std::size_t hair = std::size_t{guide} * bindings_.followPerGuide + number;
        bindings_.wispOffsets[hair] = drawInDisc(random);
        const std::uint32_t chosen = fans.draw(guide, random.uniform());
        const Vec3f barycentric = drawOwnThird(random);
        bindings_.guides[hair] = {guide, guide, guide};
        bindings_.rootWeights[hair] = Vec3f::UnitX();
        bindings_.weights[hair] = Vec3f::UnitX();
        bindings_.blends[hair] = 0;
        if (chosen == kNone) return;
        Triangle corners = triangles_[chosen];
        std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), guide), corners.end());
        bindings_.guides[hair] = {corners[0], corners[1], corners[2]};
        bindings_.rootWeights[hair] = barycentric;
        bindings_.weights[hair] = keepPartings(corners, barycentric);
        bindings_.blends[hair] = settings_.blend;
    }

    /// Gives the share of guides that diverge from the first to the first.
    Vec3f keepPartings(const Triangle& corners, Vec3f weights) const {
        for (int other = 1; other < 3; ++other) {
            const float given =
                weights[other] * divergence(corners[0], corners[static_cast<std::size_t>(other)]);
            weights[other] -= given;
            weights[0] += given;
        }
        return weights;
    }

    /// 0 for guides that lie together, 1 for guides on two sides of a parting.
    float divergence(std::uint32_t a, std::uint32_t b) const {
        const Vec3f chordA = points(a).back() - roots_[a];
        const Vec3f chordB = points(b).back() - roots_[b];
        const float angle = std::atan2(chordA.cross(chordB).norm(), chordA.dot(chordB));
        const float apart = (points(a).back() - points(b).back()).norm() - (roots_[a] - roots_[b]).norm();
        const float length = 0.5f * (lengths_[a] + lengths_[b]);
        const float spread = length > 0 ? apart / length : 0.0f;
        return std::max(fade(degrees(angle), parting_.beginAngleDegrees, parting_.endAngleDegrees),
                        fade(spread, parting_.beginSpread, parting_.endSpread));
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
    std::vector<Triangle> triangles_;
};

}  // namespace

Result<FollowBindings> bindFollowHairs(const Groom& groom, const InterpolationSettings& settings,
                                       const PartingSettings& parting) {
    if (auto status = checkSettings(settings, parting); !status) return tl::unexpected(status.error());
    auto guides = findGuides(groom);
    if (!guides) return tl::unexpected(guides.error());
    FollowBindings bindings;
    bindings.guideStrands = std::move(*guides);
    bindings.followPerGuide = settings.followPerGuide;
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
