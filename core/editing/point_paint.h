// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What brushes share that paint a value at each point of hair.

#include <algorithm>
#include <vector>

#include "core/editing/brush.h"

namespace hairloom::editing {

/// Moves nothing: it has the reach of the brushes that move points, roots included, and writes values at what
/// it reaches.
class PointPaint : public StrandBrush {
  public:
    Change dab(StrokeTarget& target, const DabContext& dab) override {
        const Reached reached = reach(target, dab);
        target.touched = reached.strands;
        return reached.strands.empty() ? Change{} : paint(target, dab, reached);
    }

  protected:
    /// `reached` has at least one strand.
    virtual Change paint(StrokeTarget& target, const DabContext& dab, const Reached& reached) = 0;

    bool edit(const DabContext&, StrandUnderBrush&) const override { return false; }

    /// Roots take the value as all other points do.
    float weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                std::span<float> weights) const override {
        const float strongest = StrandBrush::weigh(dab, settings, points, weights);
        const float away = dab.volume.fromAxis(points[0]).norm() / dab.volume.radius;
        if (away >= 1) return strongest;
        weights[0] = dab.dab.strength * dab.dab.pressure * settings.falloff.at(away) * settings.profile.at(0);
        return std::max(strongest, weights[0]);
    }

    /// Calls visit(point of the groom, its weight).
    template <class Visit>
    static void forEachPoint(const StrokeTarget& target, const Reached& reached, Visit visit) {
        const auto offsets = target.groom().offsets.view();
        for (std::size_t k = 0; k < reached.strands.size(); ++k) {
            const std::size_t first = offsets[reached.strands[k]];
            const std::size_t count = offsets[reached.strands[k] + 1] - first;
            for (std::size_t i = 0; i < count; ++i) visit(first + i, reached.weights[reached.begins[k] + i]);
        }
    }

    /// Mean of the values (one a point of the groom) by the weights, that of smoothing.
    static float meanOf(const StrokeTarget& target, const Reached& reached,
                        const std::vector<float>& values) {
        double sum = 0, weights = 0;
        forEachPoint(target, reached, [&](std::size_t point, float weight) {
            sum += static_cast<double>(weight) * static_cast<double>(values[point]);
            weights += static_cast<double>(weight);
        });
        return static_cast<float>(sum / weights);
    }

    /// Brings the values towards `wanted` by the weights, between `least` and `most`.
    static void bringTowards(const StrokeTarget& target, const Reached& reached, float wanted, float least,
                             float most, std::vector<float>& values) {
        forEachPoint(target, reached, [&](std::size_t point, float weight) {
            values[point] = std::clamp(values[point] + weight * (wanted - values[point]), least, most);
        });
    }
};

}  // namespace hairloom::editing
