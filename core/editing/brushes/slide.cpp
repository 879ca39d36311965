// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "core/base/parallel.h"
#include "core/editing/brush_list.h"
#include "core/geometry/curve.h"
#include "core/geometry/surface_walk.h"
#include "core/operations/length_constraint.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 64;

constexpr BrushInfo kInfo{
    .name = "slide",
    .label = "Slide",
    .meaning = "moves roots over the scalp, and hair with them",
    .tip = "Drag over the scalp to move hair with its roots",
    .key = "Shift+G",
    .needsHead = true,
    .worksOnSkin = true,
    .order = 205,
};

/// Holds the strands whose roots the first dab reaches. Their roots walk over the surface as the brush does,
/// on faces that carry hair, and each strand turns with the normal at its root.
class Slide final : public Brush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    void begin(StrokeTarget& target) override {
        const Groom& groom = target.groom();
        if (!groom.scalpSelection.empty()) open_.assign(groom.scalp->triangleCount(), 0);
        for (const std::uint32_t face : groom.scalpSelection) open_[face] = 1;
        turns_.assign(groom.strandCount(), Quatf::Identity());
    }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        target.touched.clear();
        Held& held = held_[dab.isMirror ? 1 : 0];
        if (dab.isFirst) held = take(target, dab);
        if (held.strands.empty() || dab.motion_ss.isZero(0)) return {};
        target.changes.points.keep(target.groom(), held.strands);
        target.changes.roots.keep(target.groom(), held.strands);
        move(target, dab, held);
        target.touched = held.strands;
        return {Part::Points | Part::Triangulation, target.touched};
    }

  private:
    struct Held {
        std::vector<std::uint32_t> strands;
        std::vector<float> weights;
    };

    static Held take(const StrokeTarget& target, const DabContext& dab) {
        Held held;
        const Groom& groom = target.groom();
        if (groom.rootBindings().size() != groom.strandCount()) return held;
        for (std::uint32_t s = 0; s < groom.strandCount(); ++s) {
            if (!target.editable[s] || groom.strand(s).empty()) continue;
            const float away = (groom.strand(s)[0] - dab.volume.centre).norm() / dab.volume.radius;
            const float weight =
                away < 1 ? dab.dab.strength * dab.dab.pressure * target.settings.falloff.at(away) : 0;
            if (!(weight > 0)) continue;
            held.strands.push_back(s);
            held.weights.push_back(weight);
        }
        return held;
    }

    void move(StrokeTarget& target, const DabContext& dab, const Held& held) {
        Groom& groom = target.groom();
        const ScalpMesh& scalp = *groom.scalp;
        const auto under = target.surface->closest(dab.previous.position_ss).surface;
        const Vec3f normal = scalp.normalAt(under.triangle, under.barycentric);
        auto& positions = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
        auto& triangles = groom.strandAttributes.edit<std::uint32_t>(attribute::kRootTriangle);
        auto& barycentrics = groom.strandAttributes.edit<Vec3f>(attribute::kRootBarycentric);
        std::vector<Vec2f>* const uvs = groom.strandAttributes.has(attribute::kRootUv)
                                            ? &groom.strandAttributes.edit<Vec2f>(attribute::kRootUv)
                                            : nullptr;
        const bool hasBase = groom.pointAttributes.has(attribute::kBasePosition);
        std::vector<Vec3f>* const base =
            hasBase ? &groom.pointAttributes.edit<Vec3f>(attribute::kBasePosition) : nullptr;
        const SkinQuery* const skin = target.settings.collide ? target.skin : nullptr;
        parallelFor(held.strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            std::vector<float> lengths;
            for (std::size_t k = begin; k < end; ++k) {
                const std::uint32_t s = held.strands[k];
                const SurfacePoint from{triangles[s], barycentrics[s]};
                const Vec3f up = scalp.normalAt(from.triangle, from.barycentric);
                const Vec3f offset = shortestArc(normal, up) * Vec3f(held.weights[k] * dab.motion_ss);
                const SurfacePoint to = walkOnSurface(scalp, from, offset, open_);
                const Vec3f nowUp = scalp.normalAt(to.triangle, to.barycentric);
                turns_[s] = (shortestArc(up, nowUp) * turns_[s]).normalized();
                triangles[s] = to.triangle;
                barycentrics[s] = to.barycentric;
                if (uvs) (*uvs)[s] = scalp.uvAt(to.triangle, to.barycentric);
                const SurfacePoint& start = target.changes.roots.kept(s);
                const Place place{scalp.pointAt(start.triangle, start.barycentric),
                                  scalp.pointAt(to.triangle, to.barycentric), turns_[s]};
                const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
                if (base) place.put(target.changes.roots.keptBase(s), std::span(*base).subspan(first, count));
                const auto points = std::span(positions).subspan(first, count);
                place.put(target.changes.points.kept(s), points);
                if (skin && count > 1) {
                    measureSegments(points, lengths);
                    keepOutside(points, lengths, *skin, target.settings.clearance);
                }
            }
        });
        for (const std::uint32_t s : held.strands) target.bounds.update(s, groom.strand(s));
    }

    /// Takes a strand, as it was, from one root to the other.
    struct Place {
        Vec3f from_ss, to_ss;
        Quatf turn;
        void put(std::span<const Vec3f> before, std::span<Vec3f> now) const {
            for (std::size_t i = 0; i < now.size(); ++i) now[i] = to_ss + turn * Vec3f(before[i] - from_ss);
        }
    };

    std::vector<std::uint8_t> open_;  ///< faces that carry hair; empty: all
    std::vector<Quatf> turns_;        ///< per strand, since the stroke began
    Held held_[2];                    ///< of the first dab, and of its mirror image
};

}  // namespace

BrushEntry slideBrush() {
    return brushEntry<Slide>(kInfo);
}

}  // namespace hairloom::editing
