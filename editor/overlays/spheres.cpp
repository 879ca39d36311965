// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {

void drawSpheres(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto& pose = view.viewport.pose();
    const QColor colour(90, 170, 255);
    const Vec3f toEye = -view.viewport.camera().forward_ws();
    for (std::size_t s = 0; s < groom.spheres.size(); ++s) {
        const CollisionSphere& sphere = groom.spheres[s];
        Vec3f centre = sphere.centre;
        if (pose && pose->head.sphereCentres_ws.size() == groom.spheres.size()) {
            centre = pose->head.sphereCentres_ws[s];
        } else if (pose) {
            centre = pose->head.head_ws * centre;
        }
        marks.circle(centre, toEye, sphere.radius, colour, 2, Marks::Depth::OnTop);
        marks.circle(centre, Vec3f::UnitY(), sphere.radius, colour, 1, Marks::Depth::OnTop);
    }
}

OverlayMode spheresOverlay() {
    return {"spheres", "Spheres", "Shows the collision spheres", drawSpheres, 50};
}

}  // namespace hairloom::editor
