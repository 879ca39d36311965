// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

void drawPenetration(const Session& session, Marks& marks) {
    constexpr float kMax = 0.002f;
    const Groom& groom = session.document.groom();
    const auto& pose = session.viewport->pose();
    const bool moved = pose && pose->head.sphereCentres_ws.size() == groom.spheres.size();
    std::vector<Vec3f> centres;
    for (std::size_t s = 0; s < groom.spheres.size(); ++s) {
        const Vec3f& rest = groom.spheres[s].centre;
        centres.push_back(moved  ? pose->head.sphereCentres_ws[s]
                          : pose ? Vec3f(pose->head.head_ws * rest)
                                 : rest);
    }
    for (const Vec3f& point : shownPositions(session)) {
        float deepest = 0;
        for (std::size_t s = 0; s < centres.size(); ++s) {
            deepest = std::max(deepest, groom.spheres[s].radius - (point - centres[s]).norm());
        }
        if (deepest > 0) marks.point(point, heat(deepest / kMax), 5, Marks::Depth::OnTop);
    }
}

}  // namespace hairloom::editor
