// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("height", "m", 0, 0.1, 0.01f, "how far a dab of full strength lifts"),
};
constexpr BrushInfo kInfo{"puff", "Puff", "lifts hair away from the skin", "presses hair onto the skin",
                          kParameters};

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

std::unique_ptr<Brush> makePuff() {
    return std::make_unique<Puff>();
}

}  // namespace hairloom::editing
