// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/editing/brush_list.h"
#include "core/operations/part.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("lift", "°", 0, 90, 25, "angle between hair and skin at the root"),
    parameter("rise", "m", 0, 0.3, 0.03f, "distance from the root over which that angle fades"),
};
constexpr BrushInfo kInfo{
    .name = "part",
    .label = "Part",
    .meaning = "lays hair away from the stroke on both sides",
    .tip = "Drag over the scalp to draw a parting",
    .key = "Shift+B",
    .parameters = kParameters,
    .needsHead = true,
    .turnsSegments = true,
    .worksOnSkin = true,
    .order = 148,
};
constexpr float kReach = 2;  ///< radii from the stroke at which hair is as it was

class PartHair final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext& dab) override {
        line_.reset();
        const DrawnCurve stroke{{dab.previous.position_ss, dab.dab.position_ss}};
        if (CurveLine::isDrawn(stroke)) line_.emplace(stroke);
        force_.reach = kReach * dab.volume.radius;
        force_.liftDegrees = target.parameter(kInfo, "lift");
        force_.rise = target.parameter(kInfo, "rise");
    }
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        if (!line_) return false;
        PartingForce force = force_;
        force.strength = strand.strongest;
        return layAwayFrom(*line_, force, strand.points, strand.lengths, strand.rootNormal_ss(), strand.skin);
    }
    /// By the root alone: what hangs over the stroke from elsewhere is not parted there.
    float weigh(const DabContext& dab, const BrushSettings& settings, std::span<const Vec3f> points,
                std::span<float> weights) const override {
        const float away = std::sqrt(dab.volume.squaredDistance(points[0])) / dab.volume.radius;
        if (away >= 1) return 0;
        const float strength = dab.dab.strength * dab.dab.pressure * settings.falloff.at(away);
        std::ranges::fill(weights, strength);
        weights[0] = 0;
        return strength;
    }

  private:
    std::optional<CurveLine> line_;
    PartingForce force_;
};

}  // namespace

BrushEntry partBrush() {
    return brushEntry<PartHair>(kInfo);
}

}  // namespace hairloom::editing
