// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushInfo kInfo{
    .name = "comb",
    .label = "Comb",
    .meaning = "drags hair along with the brush",
    .tip = "Drag to comb hair. Lengths do not change",
    .key = "C",
    .drags = true,
    .order = 110,
};

class Comb final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        if (dab.motion_ss.isZero(0)) return false;
        strand.carry(strand.points, dab.motion_ss);
        return true;
    }
};

}  // namespace

BrushEntry combBrush() {
    return brushEntry<Comb>(kInfo);
}

}  // namespace hairloom::editing
