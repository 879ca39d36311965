// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/editing/brush_list.h"
#include "core/geometry/curve.h"
#include "core/operations/reshape.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    boolParameter("grow", true, "extends hair that is too short straight up to the height"),
    parameter("longest", "m", 0.001, 5, 2, "maximum length when the brush grows"),
};
constexpr BrushInfo kInfo{
    .name = "level",
    .label = "Length to height",
    .meaning = "brings tips to the height where the stroke began",
    .tip = "Press at a height and drag to bring tips to it",
    .key = "Shift+L",
    .parameters = kParameters,
    .keepsLengths = false,
    .order = 175,
};
constexpr float kShortest = 0.001f;  ///< metres; no strand gets shorter

class Level final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext& dab) override {
        height_ = dab.dab.position_ss.y() - dab.travel_ss.y();
        grows_ = target.parameter(kInfo, "grow") != 0;
        longest_ = target.parameter(kInfo, "longest");
    }
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        const float now = polylineLength(strand.points);
        const float wanted = now + strand.strongest * (lengthAtHeight(strand.points, now) - now);
        if (wanted == now) return false;
        strand.first = 1;
        cutOrExtend(strand.points, std::max(wanted, kShortest));
        return true;
    }

  private:
    /// Where the strand crosses the height last, or would if it went on; `now` where it does neither.
    float lengthAtHeight(std::span<const Vec3f> points, float now) const {
        float arc = now;
        for (std::size_t i = points.size() - 1; i > 0; --i) {
            const Vec3f along = points[i] - points[i - 1];
            arc -= along.norm();
            const float above = points[i - 1].y() - height_, below = points[i].y() - height_;
            if ((above < 0) != (below < 0)) return arc + along.norm() * above / (above - below);
        }
        if (!grows_) return now;
        const Vec3f last = points[points.size() - 1] - points[points.size() - 2];
        const float missing = height_ - points.back().y();
        if (!(last.y() * missing > 0)) return now;
        return std::max(now, std::min(longest_, now + missing * last.norm() / last.y()));
    }

    float height_ = 0, longest_ = 0;
    bool grows_ = true;
};

}  // namespace

BrushEntry levelBrush() {
    return brushEntry<Level>(kInfo);
}

}  // namespace hairloom::editing
