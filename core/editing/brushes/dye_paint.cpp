// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"
#include "core/editing/point_paint.h"
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

class DyePaint final : public PointPaint {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    Change paint(StrokeTarget& target, const DabContext& dab, const Reached& reached) override {
        const bool wasOff = target.groom().material.dyeStrength <= 0;
        target.changes.dye.keep(target.groom(), reached.strands);
        std::vector<float>& mask = target.groom().pointAttributes.edit<float>(attribute::kPointDye);
        const bool smooths = target.parameter(kInfo, "smooth") != 0;
        const float wanted = smooths        ? meanOf(target, reached, mask)
                             : dab.sign > 0 ? target.parameter(kInfo, "amount")
                                            : 0.0f;
        bringTowards(target, reached, wanted, 0, 1, mask);
        return {wasOff ? Part::Dye | Part::Material : Part::Dye, target.touched};
    }
};

}  // namespace

BrushEntry dyePaintBrush() {
    return brushEntry<DyePaint>(kInfo);
}

}  // namespace hairloom::editing
