// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/editing/brush_list.h"
#include "core/operations/mask.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter(kMaskParameter, "", 1, kPaintedMasks, 1, "number of the mask to paint"),
    parameter("value", "", 0, 1, 1, "mask value to paint: strength of the operators that use this mask"),
    boolParameter("roots", false, "affects strands only by their roots, like a map of the scalp"),
};
constexpr BrushInfo kInfo{
    .name = "mask_paint",
    .label = "Paint mask",
    .meaning = "paints where operators apply",
    .tip = "Drag to paint where the operators with this mask apply",
    .key = "Shift+Y",
    .inverse = "paints the mask with 0",
    .parameters = kParameters,
    .movesHair = false,
    .order = 225,
};

/// A strand has one value: it takes that of its point which the brush reaches most.
class MaskPaint final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        byRoots_ = target.parameter(kInfo, "roots") != 0;
        const Reached reached = reach(target, dab);
        target.touched = reached.strands;
        if (reached.strands.empty()) return {};
        const auto number = static_cast<std::uint32_t>(target.parameter(kInfo, kMaskParameter) + 0.5f);
        target.changes.mask.keep(target.groom(), maskAttribute(number), reached.strands);
        std::vector<float>& mask = target.groom().strandAttributes.edit<float>(maskAttribute(number));
        const float wanted = dab.sign > 0 ? target.parameter(kInfo, "value") : 0.0f;
        const auto offsets = target.groom().offsets.view();
        for (std::size_t k = 0; k < reached.strands.size(); ++k) {
            const std::uint32_t s = reached.strands[k];
            const auto weights =
                std::span(reached.weights).subspan(reached.begins[k], offsets[s + 1] - offsets[s]);
            mask[s] += std::ranges::max(weights) * (wanted - mask[s]);
        }
        return {Part::Masks, target.touched};
    }

  protected:
    bool edit(const DabContext&, StrandUnderBrush&) const override { return false; }

    float weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                std::span<float> weights) const override {
        const float strongest = byRoots_ ? 0 : StrandBrush::weigh(dab, settings, points, weights);
        if (byRoots_) std::ranges::fill(weights, 0.0f);
        const float away = std::sqrt(dab.volume.squaredDistance(points[0])) / dab.volume.radius;
        if (away >= 1) return strongest;
        weights[0] = dab.dab.strength * dab.dab.pressure * settings.falloff.at(away);
        return std::max(strongest, weights[0]);
    }

  private:
    bool byRoots_ = false;
};

}  // namespace

BrushEntry maskPaintBrush() {
    return brushEntry<MaskPaint>(kInfo);
}

}  // namespace hairloom::editing
