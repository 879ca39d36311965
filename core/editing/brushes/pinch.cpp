// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushInfo kInfo{
    .name = "pinch",
    .label = "Pinch",
    .meaning = "pulls hair together under the brush",
    .tip = "Drag to pull hair together",
    .key = "I",
    .inverse = "spreads hair away from the centre of the brush",
    .order = 160,
};

class Pinch final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        for (std::size_t i = strand.first; i < strand.points.size(); ++i) {
            if (!(strand.weights[i] > 0)) continue;
            strand.points[i] -= strand.weights[i] * dab.sign * dab.volume.fromAxis(strand.points[i]);
        }
        return true;
    }
};

}  // namespace

BrushEntry pinchBrush() {
    return brushEntry<Pinch>(kInfo);
}

}  // namespace hairloom::editing
