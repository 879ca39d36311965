// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr BrushInfo kInfo{
    .name = "brush",
    .label = "Brush",
    .meaning = "turns hair in the direction of the stroke",
    .tip = "Drag to turn hair in the direction of the stroke",
    .key = "B",
    .inverse = "turns hair against the direction of the stroke",
    .drags = true,
    .turnsSegments = true,
    .order = 120,
};

class BrushAlong final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        constexpr float kNoMotion = 1e-7f;  // metres
        if (dab.motion_ss.norm() < kNoMotion) return false;
        const Vec3f wanted = dab.motion_ss.normalized() * dab.sign;
        Vec3f before = strand.points[strand.first - 1];
        for (std::size_t i = strand.first; i < strand.points.size(); ++i) {
            const Vec3f segment = strand.points[i] - before;
            before = strand.points[i];
            const float length = strand.lengths[i - 1];
            Vec3f direction = length > 0 ? Vec3f(segment / length) : wanted;
            if (strand.weights[i] > 0) {
                const Vec3f mixed = direction + strand.weights[i] * (wanted - direction);
                const float norm = mixed.norm();
                // Hair that points the opposite way turns over the outside.
                constexpr float kOpposite = 1e-3f;
                direction = norm > kOpposite ? Vec3f(mixed / norm) : strand.rootNormal_ss();
            }
            strand.points[i] = strand.points[i - 1] + direction * length;
        }
        return true;
    }
};

}  // namespace

BrushEntry brushAlongBrush() {
    return brushEntry<BrushAlong>(kInfo);
}

}  // namespace hairloom::editing
