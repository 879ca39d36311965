// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"
#include "core/operations/length_constraint.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("passes", "", 1, 20, 2, "number of passes: more smooths over longer stretches with each dab"),
};
constexpr BrushInfo kInfo{
    .name = "smooth",
    .label = "Smooth",
    .meaning = "smooths hair",
    .tip = "Drag to smooth hair",
    .key = "S",
    .parameters = kParameters,
    .turnsSegments = true,
    .order = 140,
};

class Smooth final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        passes_ = static_cast<int>(target.parameter(kInfo, "passes"));
    }
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        const std::span<Vec3f> points = strand.points;
        for (int pass = 0; pass < passes_; ++pass) {
            Vec3f before = points[strand.first - 1];
            for (std::size_t i = strand.first; i + 1 < points.size(); ++i) {
                const Vec3f middle = 0.5f * (before + points[i + 1]);
                before = points[i];
                points[i] += strand.weights[i] * (middle - points[i]);
            }
        }
        restoreLengthsByDirection(points.subspan(strand.first - 1), strand.lengths.subspan(strand.first - 1));
        return true;
    }

  private:
    int passes_ = 1;
};

}  // namespace

BrushEntry smoothBrush() {
    return brushEntry<Smooth>(kInfo);
}

}  // namespace hairloom::editing
