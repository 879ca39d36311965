// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/editing/brush_list.h"
#include "core/groom/point_dye.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("amount", "", 0, 1, 1, "mask value to paint: 1 is full dye"),
    boolParameter("smooth", false, "smooths the mask under the brush instead"),
};
constexpr BrushInfo kInfo{
    .name = "dye_paint",
    .label = "Paint dye",
    .meaning = "paints the dye of the material",
    .tip = "Drag to paint the dye of the material",
    .key = "Y",
    .inverse = "removes dye",
    .parameters = kParameters,
    .movesHair = false,
    .order = 220,
};

/// Moves nothing: it has the reach of the brushes that move points, and writes the mask at these points.
class DyePaint final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        const Reached reached = reach(target, dab);
        target.touched = reached.strands;
        if (reached.strands.empty()) return {};
        const bool wasOff = target.groom().material.dyeStrength <= 0;
        target.changes.dye.keep(target.groom(), reached.strands);
        std::vector<float>& mask = target.groom().pointAttributes.edit<float>(attribute::kPointDye);
        const float wanted = wantedValue(target, dab, reached, mask);
        forEachPoint(target, reached, [&mask, wanted](std::size_t point, float weight) {
            mask[point] = std::clamp(mask[point] + weight * (wanted - mask[point]), 0.0f, 1.0f);
        });
        return {wasOff ? Part::Dye | Part::Material : Part::Dye, target.touched};
    }

  protected:
    bool edit(const DabContext&, StrandUnderBrush&) const override { return false; }

    /// Roots take dye as all other points do.
    float weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                std::span<float> weights) const override {
        const float strongest = StrandBrush::weigh(dab, settings, points, weights);
        const float away = dab.volume.fromAxis(points[0]).norm() / dab.volume.radius;
        if (away >= 1) return strongest;
        weights[0] = dab.dab.strength * dab.dab.pressure * settings.falloff.at(away) * settings.profile.at(0);
        return std::max(strongest, weights[0]);
    }

  private:
    template <class Visit>
    static void forEachPoint(const StrokeTarget& target, const Reached& reached, Visit visit) {
        const auto offsets = target.groom().offsets.view();
        for (std::size_t k = 0; k < reached.strands.size(); ++k) {
            const std::size_t first = offsets[reached.strands[k]];
            const std::size_t count = offsets[reached.strands[k] + 1] - first;
            for (std::size_t i = 0; i < count; ++i) visit(first + i, reached.weights[reached.begins[k] + i]);
        }
    }

    static float wantedValue(const StrokeTarget& target, const DabContext& dab, const Reached& reached,
                             const std::vector<float>& mask) {
        if (target.parameter(kInfo, "smooth") == 0)
            return dab.sign > 0 ? target.parameter(kInfo, "amount") : 0.0f;
        double sum = 0, weights = 0;
        forEachPoint(target, reached, [&](std::size_t point, float weight) {
            sum += static_cast<double>(weight) * static_cast<double>(mask[point]);
            weights += static_cast<double>(weight);
        });
        return static_cast<float>(sum / weights);
    }
};

}  // namespace

BrushEntry dyePaintBrush() {
    return brushEntry<DyePaint>(kInfo);
}

}  // namespace hairloom::editing
