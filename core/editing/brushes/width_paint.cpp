// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"
#include "core/editing/point_paint.h"
#include "core/groom/point_width.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("width", "", 0.1, 10, 2,
              "width to paint, as a multiple of what the material or the file gives the hair: 1 restores it"),
    boolParameter("smooth", false, "smooths widths under the brush instead"),
};
constexpr BrushInfo kInfo{
    .name = "width_paint",
    .label = "Paint width",
    .meaning = "paints how thick hair is",
    .tip = "Drag to make hair thicker",
    .key = "Shift+W",
    .inverse = "makes it thinner by as much",
    .parameters = kParameters,
    .movesHair = false,
    .order = 225,
};

class WidthPaint final : public PointPaint {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    Change paint(StrokeTarget& target, const DabContext& dab, const Reached& reached) override {
        target.changes.widths.keep(target.groom(), attribute::kWidthChange, reached.strands);
        std::vector<float>& changes = target.groom().pointAttributes.edit<float>(attribute::kWidthChange);
        const bool smooths = target.parameter(kInfo, "smooth") != 0;
        const float width = target.parameter(kInfo, "width");
        const float wanted =
            smooths ? meanOf(target, reached, changes) : (dab.sign > 0 ? width : 1 / width) - 1;
        bringTowards(target, reached, wanted, -1, kMaxWidthChange, changes);
        return {Part::Widths, target.touched};
    }
};

}  // namespace

BrushEntry widthPaintBrush() {
    return brushEntry<WidthPaint>(kInfo);
}

}  // namespace hairloom::editing
