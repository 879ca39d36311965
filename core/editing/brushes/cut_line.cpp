// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/editing/brush_list.h"
#include "core/operations/reshape.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("shortest", "m", 0.001, 1, 0.005f, "minimum length that remains"),
};
constexpr BrushInfo kInfo{
    .name = "cut_line",
    .label = "Cut along line",
    .meaning = "cuts hair along a drawn line",
    .tip = "Draw a line to cut hair along it",
    .key = "Shift+X",
    .parameters = kParameters,
    .keepsLengths = false,
    .order = 190,
};

/// The sheet that a piece of the line sweeps along the view: between the lines of sight through its ends,
/// from the eye to `depth` behind them. What hangs before the line is in the way of the scissors wherever the
/// stroke began: hair over a nose lies far before that on the temples.
struct Sheet {
    Vec3f from, to;          ///< ends of the piece, metres
    Vec3f fromView, toView;  ///< unit length
    Vec3f normal;            ///< unit length; zero where the piece is too short to cut
    float depth;

    static Sheet of(const DabContext& dab) {
        Sheet sheet{dab.previous.position_ss, dab.dab.position_ss, dab.previous.direction_ss,
                    dab.dab.direction_ss,     Vec3f::Zero(),       dab.volume.halfLength};
        const Vec3f across = dab.motion_ss.cross(sheet.fromView + sheet.toView);
        constexpr float kShort = 1e-7f;
        if (across.norm() > kShort) sheet.normal = across.normalized();
        return sheet;
    }
    /// A point of the sheet's plane lies between the two lines of sight and is not too deep.
    bool holds(const Vec3f& point) const {
        const auto side = [&](const Vec3f& end, const Vec3f& view) {
            return (point - end).dot(view.cross(normal));
        };
        const Vec3f inward = fromView.cross(normal);
        const float sign = (to - from).dot(inward) < 0 ? -1.0f : 1.0f;
        const float deep = (point - 0.5f * (from + to)).dot((fromView + toView).normalized());
        return sign * side(from, fromView) >= 0 && sign * side(to, toView) <= 0 && deep <= depth;
    }
    /// Share of the segment before it crosses, or more than 1 where it does not.
    float crossing(const Vec3f& a, const Vec3f& b) const {
        constexpr float kNone = 2;
        const float sideA = (a - from).dot(normal);
        const float sideB = (b - from).dot(normal);
        if ((sideA < 0) == (sideB < 0)) return kNone;
        const float t = sideA / (sideA - sideB);
        return holds(a + t * (b - a)) ? t : kNone;
    }
};

class CutLine final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext& dab) override {
        shortest_ = target.parameter(kInfo, "shortest");
        sheet_ = Sheet::of(dab);
    }
    /// The box is cut by the sheet's plane.
    std::vector<std::uint32_t> mayReach(const DabContext&, const StrandBounds& bounds) const override {
        if (sheet_.normal.isZero(0)) return {};
        return bounds.find([&](const Vec3f& low, const Vec3f& high) {
            const Vec3f half = 0.5f * (high - low);
            const float reach = half.dot(sheet_.normal.cwiseAbs());
            return std::abs((low + half - sheet_.from).dot(sheet_.normal)) <= reach;
        });
    }
    /// All weigh 1 where any segment crosses.
    float weigh(const DabContext&, const BrushSettings&, std::span<const Vec3f> points,
                std::span<float> weights) const override {
        std::fill(weights.begin(), weights.end(), 0.0f);
        for (std::size_t i = 1; i < points.size(); ++i) {
            if (sheet_.crossing(points[i - 1], points[i]) <= 1) weights[i] = 1;
        }
        return *std::max_element(weights.begin(), weights.end());
    }
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        float now = 0;
        for (const float length : strand.lengths) now += length;
        float arc = 0;
        for (std::size_t i = 1; i < strand.first; ++i) arc += strand.lengths[i - 1];
        const float t = sheet_.crossing(strand.points[strand.first - 1], strand.points[strand.first]);
        const float left = std::max(arc + t * strand.lengths[strand.first - 1], shortest_);
        if (!(left < now)) return false;
        strand.first = 1;
        cutOrExtend(strand.points, left);
        return true;
    }

  private:
    float shortest_ = 0;
    Sheet sheet_{};
};

}  // namespace

BrushEntry cutLineBrush() {
    return brushEntry<CutLine>(kInfo);
}

}  // namespace hairloom::editing
