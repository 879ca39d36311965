// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <vector>

#include "core/editing/brush_list.h"
#include "core/editing/lock.h"
#include "core/operations/reshape.h"
#include "core/operations/strand_frames.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("angle", "°", 1, 180, 30, "rotation of the tips by a dab of full strength"),
};
constexpr BrushInfo kInfo{
    .name = "twist",
    .label = "Twist",
    .meaning = "twists hair under the brush around its centre",
    .tip = "Drag along a lock to twist it",
    .key = "R",
    .inverse = "twists the other way",
    .parameters = kParameters,
    .order = 164,
};

class Twist final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        angle_ = radians(target.parameter(kInfo, "angle"));
    }
    void beginStrands(const StrokeTarget& target, const Reached& reached) override {
        middle_ = middleStrand(target.groom(), reached);
    }
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        const std::span<Vec3f> points = strand.points;
        constexpr float kNear = 0.02f;  // share of the strand by which its direction is told
        float weight = 0;
        for (std::size_t i = strand.first; i < points.size(); ++i) {
            weight = std::max(weight, strand.weights[i]);
            const float t = static_cast<float>(i) / static_cast<float>(points.size() - 1);
            const Vec3f centre = pointAlong(middle_, t);
            const Vec3f axis = unitOr(pointAlong(middle_, std::min(t + kNear, 1.0f)) -
                                          pointAlong(middle_, std::max(t - kNear, 0.0f)),
                                      strand.rootNormal_ss());
            const Eigen::AngleAxisf turn(dab.sign * angle_ * weight * t, axis);
            points[i] = centre + turn * Vec3f(points[i] - centre);
        }
        return true;
    }

  private:
    float angle_ = 0;
    std::vector<Vec3f> middle_;
};

}  // namespace

BrushEntry twistBrush() {
    return brushEntry<Twist>(kInfo);
}

}  // namespace hairloom::editing
