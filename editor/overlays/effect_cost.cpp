// SPDX-License-Identifier: GPL-3.0-or-later
// What the simulation spends on each strand: the measured times of the effects, shared out over the points
// that they work on. Strands at rest, which the engine leaves out, cost nothing; collision is shared by those
// within reach of a sphere.
#include <algorithm>

#include "core/groom/spheres.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

bool isAboutSpheres(const std::string& effect) {
    return effect == "collision" || effect == "collisionRadius" || effect == "continuousCollision";
}

/// Moved since the frame before by more than its root did.
bool isAwake(const Groom& groom, std::size_t strand, const PlayedFrame& frame) {
    if (!frame.before) return true;
    constexpr float kStill = 1e-6f;  // metres
    const std::uint32_t root = groom.offsets[strand], tip = groom.offsets[strand + 1] - 1;
    const auto displacement = [&](std::uint32_t p) -> Vec3f {
        return frame.pose->positions_ws[p] - frame.before->positions_ws[p];
    };
    return (displacement(tip) - displacement(root)).norm() > kStill ||
           (displacement((root + tip) / 2) - displacement(root)).norm() > kStill;
}

/// At rest: the head carries its spheres along.
bool reachesSphere(const Groom& groom, const ColliderDistance& distance, std::size_t strand) {
    const auto points = groom.strand(strand);
    float length = 0;
    for (std::size_t p = 1; p < points.size(); ++p) length += (points[p] - points[p - 1]).norm();
    return distance(points.front()) < length;
}

void drawEffectCost(const OverlayView& view, Marks& marks) {
    const auto& frame = view.player.frame();
    const Groom& groom = view.groom;
    if (!frame || frame->pose->positions_ws.size() != groom.pointCount()) return;
    double all = 0, spheres = 0;
    for (const EffectReport& effect : frame->stats.effects) {
        (isAboutSpheres(effect.name) ? spheres : all) += effect.milliseconds.value_or(0);
    }
    const ColliderDistance distance(groom.spheres);
    std::vector<float> points(groom.strandCount()), near(groom.strandCount());
    double awake = 0, reached = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (!isAwake(groom, s, *frame)) continue;
        points[s] = static_cast<float>(groom.offsets[s + 1] - groom.offsets[s]);
        if (reachesSphere(groom, distance, s)) near[s] = points[s];
        awake += static_cast<double>(points[s]);
        reached += static_cast<double>(near[s]);
    }
    std::vector<float> cost(groom.strandCount());
    const auto perPoint = static_cast<float>(all / std::max(awake, 1.0));
    const auto perNear = static_cast<float>(spheres / std::max(reached, 1.0));
    float maximum = 0;
    for (std::size_t s = 0; s < cost.size(); ++s) {
        cost[s] = points[s] * perPoint + near[s] * perNear;
        maximum = std::max(maximum, cost[s]);
    }
    const auto& shown = frame->pose->positions_ws;
    for (std::size_t s = 0; s < cost.size(); ++s) {
        const QColor colour = cost[s] > 0 ? heat(cost[s] / maximum) : QColor(110, 130, 160);
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p)
            marks.line(shown[p - 1], shown[p], colour, 1);
    }
}

}  // namespace

OverlayMode effectCostOverlay() {
    return {"effectCost", "Effect cost",
            "Colours strands by their simulation cost during playback. Red costs most, grey is at "
            "rest and costs nothing",
            drawEffectCost, 110};
}

}  // namespace hairloom::editor
