// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

void drawSpheres(const Session& session, Marks& marks) {
    const Groom& groom = session.document.groom();
    const auto& pose = session.viewport->pose();
    const QColor colour(90, 170, 255);
    const Vec3f toEye = -session.viewport->camera().forward_ws();
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

}  // namespace hairloom::editor
