// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/editing/brush_list.h"
#include "core/geometry/curve.h"
#include "core/operations/reshape.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("rate", "", 0, 1, 0.1f, "change in length by a dab of full strength, as a share of the length"),
    boolParameter("rescale", true, "scales the shape; when off, hair extends straight or is cut"),
    parameter("shortest", "m", 0.001, 1, 0.005f, "minimum length when the brush shortens"),
    parameter("longest", "m", 0.001, 5, 2, "maximum length when the brush grows"),
};
constexpr BrushInfo kInfo{
    .name = "length",
    .label = "Length",
    .meaning = "lengthens hair",
    .tip = "Drag to lengthen hair",
    .key = "L",
    .inverse = "shortens hair",
    .parameters = kParameters,
    .keepsLengths = false,
    .order = 170,
};

class Length final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        rate_ = target.parameter(kInfo, "rate");
        rescale_ = target.parameter(kInfo, "rescale") != 0;
        shortest_ = target.parameter(kInfo, "shortest");
        longest_ = std::max(shortest_, target.parameter(kInfo, "longest"));
    }
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        const float now = polylineLength(strand.points);
        const float wanted = now * (1 + dab.sign * rate_ * strand.strongest);
        const float bounded = dab.sign > 0 ? std::max(now, std::min(wanted, longest_))
                                           : std::min(now, std::max(wanted, shortest_));
        if (bounded == now) return false;
        strand.first = 1;
        if (rescale_) {
            scaleToLength(strand.points, bounded);
        } else {
            cutOrExtend(strand.points, bounded);
        }
        return true;
    }

  private:
    float rate_ = 0, shortest_ = 0, longest_ = 0;
    bool rescale_ = true;
};

}  // namespace

BrushEntry lengthBrush() {
    return brushEntry<Length>(kInfo);
}

}  // namespace hairloom::editing
