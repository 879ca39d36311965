// SPDX-License-Identifier: GPL-3.0-or-later
// The loop that all brushes share that move points of strands.

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/profiler.h"
#include "core/editing/brush.h"
#include "core/geometry/curve.h"
#include "core/operations/length_constraint.h"
#include "core/operations/strand_frames.h"

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

/// BrushVolume::squaredDistance of points that lie one after the other, written so that it compiles to
/// vectors.
void squaredDistances(const BrushVolume& volume, const float* xyz, std::span<float> squares) {
    const float cx = volume.centre.x(), cy = volume.centre.y(), cz = volume.centre.z();
    const float ax = volume.axis.x(), ay = volume.axis.y(), az = volume.axis.z();
    const float maximum = volume.halfLength;
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const float x = xyz[3 * i] - cx, y = xyz[3 * i + 1] - cy, z = xyz[3 * i + 2] - cz;
        const float along = std::min(std::max(x * ax + y * ay + z * az, -maximum), maximum);
        const float u = x - ax * along, v = y - ay * along, w = z - az * along;
        squares[i] = u * u + v * v + w * w;
    }
}

/// Compiles to vectors, which a search that stops early does not.
bool anyBelow(std::span<const float> values, float limit) {
    int any = 0;
    for (const float value : values) any |= static_cast<int>(value < limit);
    return any != 0;
}

}  // namespace

void StrandUnderBrush::turnTowards(std::span<const Vec3f> shape) {
    Vec3f last = points[first - 1];
    for (std::size_t i = first; i < points.size(); ++i) {
        const Vec3f own = unitOr(points[i] - last, rootNormal_ss());
        const Vec3f wanted = unitOr(shape[i] - shape[i - 1], own);
        const Quatf turn = Quatf::Identity().slerp(weights[i], shortestArc(own, wanted));
        last = points[i];
        points[i] = points[i - 1] + (turn * own).normalized() * lengths[i - 1];
    }
}

float StrandBrush::weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                         std::span<float> weights) const {
    const BrushVolume& volume = dab.volume;
    const std::size_t count = points.size();
    thread_local std::vector<float> scratch;
    scratch.resize(2 * count + 3 * count);
    const std::span<float> ofPoints = std::span(scratch).first(count);
    const std::span<float> ofMiddles = std::span(scratch).subspan(count, count - 1);
    const std::span<float> middles = std::span(scratch).subspan(2 * count, 3 * (count - 1));
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    const float* const xyz = points.data()->data();
    for (std::size_t k = 0; k < middles.size(); ++k) middles[k] = 0.5f * (xyz[k] + xyz[k + 3]);
    squaredDistances(volume, xyz, ofPoints);
    squaredDistances(volume, middles.data(), ofMiddles);
    const float squaredRadius = volume.radius * volume.radius;
    if (!anyBelow(ofPoints.subspan(1), squaredRadius) && !anyBelow(ofMiddles, squaredRadius)) return 0;

    const float strength = dab.dab.strength * dab.dab.pressure;
    const float perPoint = 1.0f / static_cast<float>(count - 1);
    float strongest = 0;
    weights[0] = 0;
    for (std::size_t i = 1; i < count; ++i) {
        float square = std::min(ofMiddles[i - 1], ofPoints[i]);
        if (i + 1 < count) square = std::min(square, ofMiddles[i]);
        weights[i] = 0;
        if (square >= squaredRadius) continue;
        const float along = static_cast<float>(i) * perPoint;
        weights[i] =
            strength * settings.falloff.at(std::sqrt(square) / volume.radius) * settings.profile.at(along);
        strongest = std::max(strongest, weights[i]);
    }
    return strongest;
}

std::vector<std::uint32_t> StrandBrush::mayReach(const DabContext& dab, const StrandBounds& bounds) const {
    return bounds.find(BoxTest(dab.volume));
}

Reached StrandBrush::reach(const StrokeTarget& target, const DabContext& dab) const {
    const auto positions = target.groom().positions();
    const auto offsets = target.groom().offsets.view();
    const std::vector<std::uint32_t> candidates = mayReach(dab, target.bounds);
    constexpr std::size_t kPiece = 512;
    std::vector<Reached> pieces((candidates.size() + kPiece - 1) / kPiece);
    parallelFor(candidates.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        Reached& piece = pieces[begin / kPiece];
        std::vector<float> weights;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t s = candidates[k];
            if (!target.editable[s]) continue;
            const auto strand = positions.subspan(offsets[s], offsets[s + 1] - offsets[s]);
            if (strand.size() < 2) continue;
            weights.resize(strand.size());
            if (!(weigh(dab, target.settings, strand, weights) > 0)) continue;
            piece.strands.push_back(s);
            piece.begins.push_back(static_cast<std::uint32_t>(piece.weights.size()));
            piece.weights.insert(piece.weights.end(), weights.begin(), weights.end());
        }
    });
    Reached reached;
    for (const Reached& piece : pieces) {
        const auto before = static_cast<std::uint32_t>(reached.weights.size());
        reached.strands.insert(reached.strands.end(), piece.strands.begin(), piece.strands.end());
        for (const std::uint32_t first : piece.begins) reached.begins.push_back(before + first);
        reached.weights.insert(reached.weights.end(), piece.weights.begin(), piece.weights.end());
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
    const bool keepsLengths = info().keepsLengths, turnsSegments = info().turnsSegments;
    // Lengths that change move turns along the points.
    const bool asMade = info().makesTurns || !keepsLengths;
    const SkinQuery* skin = target.settings.collide ? target.skin : nullptr;
    std::vector<std::uint8_t> changed(reached.strands.size(), 0);
    parallelFor(reached.strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> lengths, turns;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t s = reached.strands[k];
            const std::size_t offset = groom.offsets[s];
            const auto points = std::span(positions).subspan(offset, groom.offsets[s + 1] - offset);
            const auto weights = std::span(reached.weights).subspan(reached.begins[k], points.size());
            measureSegments(points, lengths);
            measureTurns(points, turns);
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
            if (!keepsLengths) {
                measureSegments(points, lengths);
            } else if (!turnsSegments) {
                restoreLengths(points.subspan(strand.first - 1),
                               std::span<const float>(lengths).subspan(strand.first - 1));
            }
            if (asMade) measureTurns(points, turns);
            settle(points, lengths, turns, skin, target.settings.clearance, strand.first);
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
        beginStrands(target, held);
        editReached(target, dab, held);
    } else {
        const Reached reached = reach(target, dab);
        beginStrands(target, reached);
        editReached(target, dab, reached);
    }
    if (target.touched.empty()) return {};
    return {Part::Points, target.touched};
}

}  // namespace hairloom::editing
