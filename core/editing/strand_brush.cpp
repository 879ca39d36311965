// SPDX-License-Identifier: GPL-3.0-or-later
// The loop that all brushes share that move points of strands.

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/profiler.h"
#include "core/editing/brush.h"
#include "core/groom/brushes/length_constraint.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 128;

/// Attributes that every strand's edit looks at.
struct StrandFacts {
    std::span<const std::uint32_t> ids;
    std::span<const std::uint32_t> triangles;
    std::span<const Vec3f> barycentrics;
    const ScalpMesh* scalp;

    explicit StrandFacts(const Groom& groom)
        : ids(groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId)),
          triangles(groom.strandAttributes.view<std::uint32_t>(attribute::kRootTriangle)),
          barycentrics(groom.strandAttributes.view<Vec3f>(attribute::kRootBarycentric)),
          scalp(groom.scalp.get()) {}
    std::uint32_t id(std::uint32_t s) const { return s < ids.size() ? ids[s] : s; }
    bool isBound(std::uint32_t s) const { return scalp && s < triangles.size() && s < barycentrics.size(); }
};

std::size_t firstWeighted(std::span<const float> weights) {
    std::size_t first = 1;
    while (first + 1 < weights.size() && !(weights[first] > 0)) ++first;
    return first;
}

}  // namespace

float StrandBrush::weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                         std::span<float> weights) const {
    const float squaredRadius = dab.volume.radius * dab.volume.radius;
    const float strength = dab.dab.strength * dab.dab.pressure;
    const float perPoint = 1.0f / static_cast<float>(points.size() - 1);
    float strongest = 0;
    weights[0] = 0;
    float before = dab.volume.squaredDistance(0.5f * (points[0] + points[1]));
    for (std::size_t i = 1; i < points.size(); ++i) {
        float nearest = std::min(before, dab.volume.squaredDistance(points[i]));
        if (i + 1 < points.size()) {
            before = dab.volume.squaredDistance(0.5f * (points[i] + points[i + 1]));
            nearest = std::min(nearest, before);
        }
        weights[i] = 0;
        if (nearest >= squaredRadius) continue;
        const float along = static_cast<float>(i) * perPoint;
        weights[i] = strength * settings.falloff.at(std::sqrt(nearest) / dab.volume.radius) *
                     settings.profile.at(along);
        strongest = std::max(strongest, weights[i]);
    }
    return strongest;
}

Reached StrandBrush::reach(const StrokeTarget& target, const DabContext& dab) const {
    const Groom& groom = target.groom();
    const std::vector<std::uint32_t> candidates =
        target.bounds.find([&](const StrandBounds::Box& box) { return mayReach(dab, box); });
    std::vector<std::uint32_t> begins;
    begins.reserve(candidates.size());
    std::uint32_t points = 0;
    for (const std::uint32_t s : candidates) {
        begins.push_back(points);
        if (target.editable[s]) points += groom.offsets[s + 1] - groom.offsets[s];
    }
    Reached reached;
    reached.weights.resize(points);
    std::vector<std::uint8_t> isReached(candidates.size(), 0);
    parallelFor(candidates.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t s = candidates[k];
            const auto strand = groom.strand(s);
            if (!target.editable[s] || strand.size() < 2) continue;
            const auto weights = std::span(reached.weights).subspan(begins[k], strand.size());
            isReached[k] = weigh(dab, target.settings, strand, weights) > 0 ? 1 : 0;
        }
    });
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (!isReached[k]) continue;
        reached.strands.push_back(candidates[k]);
        reached.begins.push_back(begins[k]);
    }
    return reached;
}

void StrandBrush::editReached(StrokeTarget& target, const DabContext& dab, const Reached& reached) {
    target.touched.clear();
    if (reached.strands.empty()) return;
    target.changes.points.keep(target.groom(), reached.strands);
    std::vector<Vec3f>& positions = target.groom().pointAttributes.edit<Vec3f>(attribute::kPosition);
    const Groom& groom = target.groom();
    const StrandFacts facts(groom);
    const bool keepsLengths = info().keepsLengths;
    const SkinQuery* skin = target.settings.collide ? target.skin : nullptr;
    std::vector<std::uint8_t> changed(reached.strands.size(), 0);
    parallelFor(reached.strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t s = reached.strands[k];
            const std::size_t offset = groom.offsets[s];
            const auto points = std::span(positions).subspan(offset, groom.offsets[s + 1] - offset);
            const auto weights = std::span(reached.weights).subspan(reached.begins[k], points.size());
            measureSegments(points, lengths);
            StrandUnderBrush strand{points,
                                    target.changes.points.kept(s),
                                    weights,
                                    lengths,
                                    firstWeighted(weights),
                                    *std::max_element(weights.begin(), weights.end()),
                                    s,
                                    facts.id(s),
                                    facts.isBound(s) ? facts.triangles[s] : 0,
                                    facts.isBound(s) ? facts.barycentrics[s] : Vec3f(Vec3f::Zero()),
                                    facts.isBound(s) ? facts.scalp : nullptr,
                                    skin};
            if (!edit(dab, strand)) continue;
            if (keepsLengths) {
                restoreLengths(points.subspan(strand.first - 1),
                               std::span<const float>(lengths).subspan(strand.first - 1));
            } else {
                measureSegments(points, lengths);
            }
            if (skin) keepOutside(points, lengths, *skin, target.settings.clearance, strand.first);
            target.bounds.update(s, points);
            changed[k] = 1;
        }
    });
    for (std::size_t k = 0; k < changed.size(); ++k) {
        if (changed[k]) target.touched.push_back(reached.strands[k]);
    }
}

Change StrandBrush::dab(StrokeTarget& target, const DabContext& dab) {
    HAIRLOOM_PROFILE("editing: dab");
    beginDab(target, dab);
    if (holdsOn()) {
        Reached& held = held_[dab.isMirror ? 1 : 0];
        if (dab.isFirst) held = reach(target, dab);
        editReached(target, dab, held);
    } else {
        editReached(target, dab, reach(target, dab));
    }
    if (target.touched.empty()) return {};
    return {Part::Points, target.touched};
}

}  // namespace hairloom::editing
