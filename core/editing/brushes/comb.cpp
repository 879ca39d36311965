// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushInfo kInfo{"comb", "Comb", "drags hair along with the brush", "", {}, true, false, true};

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

std::unique_ptr<Brush> makeComb() {
    return std::make_unique<Comb>();
}

}  // namespace hairloom::editing
