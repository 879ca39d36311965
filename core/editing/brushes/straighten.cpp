// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "core/editing/brush_list.h"
#include "core/operations/straighten.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("over", "m", 0, 1, 0.08f,
              "bends up to this length are removed. Longer bends stay. 0 makes straight lines"),
};
constexpr BrushInfo kInfo{
    .name = "straighten",
    .label = "Straighten",
    .meaning = "removes waves and curls and keeps the fall",
    .tip = "Drag to remove waves and curls. The fall over the head stays",
    .key = "T",
    .parameters = kParameters,
    .turnsSegments = true,
    .order = 142,
};

class Straighten final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        over_ = target.parameter(kInfo, "over");
    }
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        std::vector<Vec3f> straight(strand.points.begin(), strand.points.end());
        straightenStrand(straight, strand.lengths, over_, 1);
        strand.turnTowards(straight);
        return true;
    }

  private:
    float over_ = 0;
};

}  // namespace

BrushEntry straightenBrush() {
    return brushEntry<Straighten>(kInfo);
}

}  // namespace hairloom::editing
