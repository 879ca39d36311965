// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/editing/brush_list.h"
#include "core/editing/lock.h"
#include "core/operations/reshape.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("profile", "", 0.1, 10, 1.5f,
              "how the pull grows from the root: 1 linearly, above 1 nearer to the tip"),
};
constexpr BrushInfo kInfo{
    .name = "clump",
    .label = "Clump",
    .meaning = "gathers hair under the brush into a clump",
    .tip = "Drag to gather hair under the brush into a clump",
    .key = "K",
    .inverse = "spreads the clump",
    .parameters = kParameters,
    .order = 162,
};

class Clump final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        profile_ = target.parameter(kInfo, "profile");
    }
    void beginStrands(const StrokeTarget& target, const Reached& reached) override {
        middle_ = middleStrand(target.groom(), reached);
    }
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        const std::span<Vec3f> points = strand.points;
        float weight = 0;
        for (std::size_t i = strand.first; i < points.size(); ++i) {
            weight = std::max(weight, strand.weights[i]);
            const float t = static_cast<float>(i) / static_cast<float>(points.size() - 1);
            points[i] += dab.sign * weight * std::pow(t, profile_) * (pointAlong(middle_, t) - points[i]);
        }
        return true;
    }

  private:
    float profile_ = 1;
    std::vector<Vec3f> middle_;
};

}  // namespace

BrushEntry clumpBrush() {
    return brushEntry<Clump>(kInfo);
}

}  // namespace hairloom::editing
