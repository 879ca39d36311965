// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/groom/spheres.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {

void drawSpheres(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto& pose = view.viewport.pose();
    const QColor colour(90, 170, 255);
    const Vec3f toEye = -view.viewport.camera().forward_ws();
    const auto centreOf = [&](std::size_t s) -> Vec3f {
        const Vec3f& rest = groom.spheres[s].centre;
        if (pose && pose->head.sphereCentres_ws.size() == groom.spheres.size())
            return pose->head.sphereCentres_ws[s];
        return pose ? Vec3f(pose->head.head_ws * rest) : rest;
    };
    for (std::size_t s = 0; s < groom.spheres.size(); ++s) {
        const float radius = groom.spheres[s].radius;
        marks.circle(centreOf(s), toEye, radius, colour, 2, Marks::Depth::OnTop);
        marks.circle(centreOf(s), Vec3f::UnitY(), radius, colour, 1, Marks::Depth::OnTop);
    }
    for (const auto& [first, second] : capsulesOf(groom.spheres)) {
        const Vec3f from = centreOf(first), to = centreOf(second);
        const Vec3f side = (to - from).cross(toEye);
        if (!(side.norm() > 1e-6f)) continue;  // seen along its axis
        // Where the outline touches both circles: across the axis, leant by the cone's angle.
        const float narrows = groom.spheres[first].radius - groom.spheres[second].radius;
        const float lean = narrows / (to - from).norm();
        if (!(std::abs(lean) < 1)) continue;  // one holds the other
        const Vec3f along = (to - from).normalized() * lean;
        for (const float way : {-1.0f, 1.0f}) {
            const Vec3f across = along + side.normalized() * (way * std::sqrt(1 - lean * lean));
            marks.line(from + across * groom.spheres[first].radius,
                       to + across * groom.spheres[second].radius, colour, 2, Marks::Depth::OnTop);
        }
    }
}

OverlayMode spheresOverlay() {
    return {"spheres", "Spheres", "Shows the collision spheres, and the capsules between joined ones",
            drawSpheres, 50};
}

}  // namespace hairloom::editor
