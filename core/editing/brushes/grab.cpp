// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushInfo kInfo{
    .name = "grab",
    .label = "Grab",
    .meaning = "grabs hair and moves it",
    .tip = "Drag to grab hair and move it",
    .key = "G",
    .order = 130,
};

class Grab final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    bool holdsOn() const override { return true; }
    /// From where the strand was at the start, so that hair that is carried to and fro comes back.
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        if (dab.isFirst) return false;
        strand.carry(strand.atStart, dab.travel_ss);
        return true;
    }
};

}  // namespace

BrushEntry grabBrush() {
    return brushEntry<Grab>(kInfo);
}

}  // namespace hairloom::editing
