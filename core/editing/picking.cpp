// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/picking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 256;
constexpr float kBehindHead = 0.002f;  ///< metres by which hair may lie behind the skin and still be seen

/// All that the cursor's circle covers lies in this cone (or cylinder, for parallel views).
class PickCone {
  public:
    PickCone(const View& view, const Vec2f& px, float radius_px) : ray_(view.rayAt(px)) {
        // The way along the ray is at least the depth, so the cone holds all of the circle.
        radiusAtOrigin_ = view.metresPerPixel(0) * radius_px;
        radiusPerMetre_ = (view.metresPerPixel(1) - view.metresPerPixel(0)) * radius_px;
        for (Eigen::Index i = 0; i < 3; ++i) {
            constexpr float kParallel = 1e-12f;
            const float along = ray_.direction_ss[i];
            perMetre_[i] = 1 / (std::abs(along) < kParallel ? std::copysign(kParallel, along) : along);
        }
    }
    /// The ray against the box grown by the cone's radius where it leaves the box.
    bool mayTouch(const Vec3f& low, const Vec3f& high) const {
        const Vec3f half = 0.5f * (high - low);
        const Vec3f toMiddle = low + half - ray_.origin_ss;
        const float farthest =
            toMiddle.dot(ray_.direction_ss) + half.dot(Vec3f(ray_.direction_ss.cwiseAbs()));
        if (!(farthest > 0)) return false;
        const Vec3f grown = half + Vec3f::Constant(radiusAtOrigin_ + radiusPerMetre_ * farthest);
        float enter = 0;
        float leave = farthest;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const float a = (toMiddle[i] - grown[i]) * perMetre_[i];
            const float b = (toMiddle[i] + grown[i]) * perMetre_[i];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    }

  private:
    Ray ray_;
    Vec3f perMetre_;  ///< one by the ray's direction
    float radiusAtOrigin_;
    float radiusPerMetre_;
};

/// Whether strands are there to be seen.
class ShownTest {
  public:
    explicit ShownTest(const Groom& groom)
        : hidden_(groom.strandAttributes.view<std::uint8_t>(attribute::kHidden)),
          layerOf_(groom.strandAttributes.view<std::uint32_t>(attribute::kLayer)),
          layers_(groom.layers) {}
    bool operator()(std::size_t s) const {
        const std::size_t layer = s < layerOf_.size() ? layerOf_[s] : 0;
        const bool isHidden = s < hidden_.size() && hidden_[s] != 0;
        return !isHidden && (layer >= layers_.size() || layers_[layer].visible);
    }

  private:
    std::span<const std::uint8_t> hidden_;
    std::span<const std::uint32_t> layerOf_;
    std::span<const Layer> layers_;
};

/// Nearest place of a screen segment to a pixel.
float nearestAlong(const Vec2f& px, const Vec2f& from, const Vec2f& to) {
    const Vec2f along = to - from;
    const float length = along.squaredNorm();
    return length > 0 ? std::clamp((px - from).dot(along) / length, 0.0f, 1.0f) : 0.0f;
}

/// Screen positions interpolate in 1/depth; this gives the place on the segment in space.
float throughPerspective(float t, float depthFrom, float depthTo, bool isParallel) {
    if (isParallel) return t;
    return t * depthFrom / (depthTo + t * (depthFrom - depthTo));
}

class StrandProbe {
  public:
    StrandProbe(const View& view, const Vec2f& px, const PickOptions& options, float headDepth)
        : view_(view),
          px_(px),
          options_(options),
          headDepth_(headDepth),
          isParallel_(view.metresPerPixel(1) == view.metresPerPixel(2)) {}

    /// The best place of a strand, if any is near enough.
    std::optional<StrandPick> look(std::uint32_t strand, std::span<const Vec3f> points) const {
        std::optional<StrandPick> best;
        const auto offer = [&](std::optional<StrandPick> pick) {
            if (pick && (!best || better(*pick, *best))) best = pick;
        };
        if (options_.part == StrandPart::Root) {
            offer(place(strand, points, 0, 0));
        } else if (options_.part == StrandPart::Tip) {
            offer(place(strand, points, points.size() - 2, 1));
        } else {
            auto from = view_.project(points[0]);
            for (std::size_t i = 0; i + 1 < points.size(); ++i) {
                const auto to = view_.project(points[i + 1]);
                if (from && to) offer(segment(strand, points, i, *from, *to));
                from = to;
            }
        }
        return best;
    }
    static bool better(const StrandPick& a, const StrandPick& b) {
        const auto rank = [](const StrandPick& p) {
            return std::tuple(std::floor(p.distance_px), p.depth, p.strand);
        };
        return rank(a) < rank(b);
    }

  private:
    std::optional<StrandPick> segment(std::uint32_t strand, std::span<const Vec3f> points, std::size_t i,
                                      const ScreenPoint& from, const ScreenPoint& to) const {
        const float t = nearestAlong(px_, from.px, to.px);
        constexpr float kRounding = 0.01f;  // pixels
        const float distance = (from.px + t * (to.px - from.px) - px_).norm();
        if (!(distance <= options_.radius_px + kRounding)) return std::nullopt;
        return place(strand, points, i, throughPerspective(t, from.depth, to.depth, isParallel_));
    }
    std::optional<StrandPick> place(std::uint32_t strand, std::span<const Vec3f> points, std::size_t i,
                                    float along) const {
        const Vec3f position = points[i] + along * (points[i + 1] - points[i]);
        const auto seen = view_.project(position);
        if (!seen) return std::nullopt;
        const float distance = (seen->px - px_).norm();
        if (!(distance <= options_.radius_px) || seen->depth > headDepth_) return std::nullopt;
        return StrandPick{strand, static_cast<std::uint32_t>(i), along, position, distance, seen->depth};
    }

    const View& view_;
    Vec2f px_;
    PickOptions options_;
    float headDepth_;
    bool isParallel_;
};

}  // namespace

std::vector<std::uint8_t> shownStrands(const Groom& groom) {
    const ShownTest isShown(groom);
    std::vector<std::uint8_t> shown(groom.strandCount());
    for (std::size_t s = 0; s < shown.size(); ++s) shown[s] = isShown(s) ? 1 : 0;
    return shown;
}

std::optional<SurfaceTree::Hit> pickHead(const SurfaceTree* surface, const View& view, const Vec2f& px) {
    if (!surface) return std::nullopt;
    const Ray ray = view.rayAt(px);
    return surface->firstHit(ray.origin_ss, ray.direction_ss);
}

std::optional<StrandPick> pickStrand(const Groom& groom, const StrandBounds& bounds,
                                     const SurfaceTree* surface, const View& view, const Vec2f& px,
                                     const PickOptions& options) {
    float headDepth = std::numeric_limits<float>::infinity();
    if (!options.throughHead) {
        if (const auto head = pickHead(surface, view, px)) {
            const auto seen = view.project(head->position);
            if (seen) headDepth = seen->depth + kBehindHead;
        }
    }
    const PickCone cone(view, px, options.radius_px);
    const StrandProbe probe(view, px, options, headDepth);
    const ShownTest isShown(groom);
    const auto positions = groom.positions();
    const auto offsets = groom.offsets.view();
    const std::vector<std::uint32_t> candidates =
        bounds.find([&](const Vec3f& low, const Vec3f& high) { return cone.mayTouch(low, high); });
    std::vector<std::optional<StrandPick>> picks(candidates.size());
    parallelFor(candidates.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t s = candidates[k];
            const std::size_t count = offsets[s + 1] - offsets[s];
            if (count >= 2 && isShown(s)) picks[k] = probe.look(s, positions.subspan(offsets[s], count));
        }
    });
    std::optional<StrandPick> best;
    for (const auto& pick : picks) {
        if (pick && (!best || StrandProbe::better(*pick, *best))) best = pick;
    }
    return best;
}

}  // namespace hairloom::editing
