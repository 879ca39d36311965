// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("height", "m", 0, 0.1, 0.01f, "height that a dab of full strength lifts"),
};
constexpr BrushInfo kInfo{
    .name = "puff",
    .label = "Puff",
    .meaning = "lifts hair away from the skin",
    .tip = "Drag to lift hair away from the skin",
    .key = "U",
    .inverse = "presses hair onto the skin",
    .parameters = kParameters,
    .order = 150,
};

class Puff final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        height_ = target.parameter(kInfo, "height");
    }
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        strand.carry(strand.points, strand.rootNormal_ss() * (height_ * dab.sign));
        return true;
    }

  private:
    float height_ = 0;
};

}  // namespace

BrushEntry puffBrush() {
    return brushEntry<Puff>(kInfo);
}

}  // namespace hairloom::editing
