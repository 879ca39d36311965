// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "core/editing/brush_list.h"
#include "core/operations/reshape.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("shortest", "m", 0.001, 1, 0.005f, "minimum length that remains"),
};
constexpr BrushInfo kInfo{
    .name = "cut",
    .label = "Cut",
    .meaning = "cuts hair where it first meets the brush",
    .tip = "Drag to cut hair where it meets the brush",
    .key = "X",
    .parameters = kParameters,
    .keepsLengths = false,
    .order = 180,
};

class Cut final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        shortest_ = target.parameter(kInfo, "shortest");
    }
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        const float cut = lengthToBrush(dab.volume, strand);
        float now = 0;
        for (const float length : strand.lengths) now += length;
        const float left = std::max(cut, shortest_);
        if (!(left < now)) return false;
        strand.first = 1;
        cutOrExtend(strand.points, left);
        return true;
    }

  private:
    /// Arc length at which the strand enters the brush; infinite where it does not.
    static float lengthToBrush(const BrushVolume& volume, const StrandUnderBrush& strand) {
        constexpr int kSteps = 16;     // of a segment, to find where it enters
        constexpr int kHalvings = 12;  // of such a step
        const float squaredRadius = volume.radius * volume.radius;
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            const Vec3f& from = strand.points[i - 1];
            const Vec3f& to = strand.points[i];
            const auto isInside = [&](float t) {
                return volume.squaredDistance(from + t * (to - from)) < squaredRadius;
            };
            // Points without weight have no part of their segments near.
            const bool isNear = strand.weights[i] > 0 || strand.weights[i - 1] > 0;
            for (int step = 0; isNear && step <= kSteps; ++step) {
                float inside = static_cast<float>(step) / kSteps;
                if (!isInside(inside)) continue;
                float outside = step == 0 ? 0 : static_cast<float>(step - 1) / kSteps;
                for (int h = 0; h < kHalvings; ++h) {
                    const float middle = 0.5f * (inside + outside);
                    (isInside(middle) ? inside : outside) = middle;
                }
                return arc + inside * strand.lengths[i - 1];
            }
            arc += strand.lengths[i - 1];
        }
        return std::numeric_limits<float>::infinity();
    }

    float shortest_ = 0;
};

}  // namespace

BrushEntry cutBrush() {
    return brushEntry<Cut>(kInfo);
}

}  // namespace hairloom::editing
