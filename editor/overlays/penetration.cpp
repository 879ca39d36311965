// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/spheres.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawPenetration(const OverlayView& view, Marks& marks) {
    constexpr float kMax = 0.002f;
    const Groom& groom = view.groom;
    const auto& pose = view.viewport.pose();
    const bool moved = pose && pose->head.sphereCentres_ws.size() == groom.spheres.size();
    std::vector<Vec3f> centres;
    for (std::size_t s = 0; s < groom.spheres.size(); ++s) {
        const Vec3f& rest = groom.spheres[s].centre;
        centres.push_back(moved  ? pose->head.sphereCentres_ws[s]
                          : pose ? Vec3f(pose->head.head_ws * rest)
                                 : rest);
    }
    const ColliderDistance distance(groom.spheres, centres);
    for (const Vec3f& point : shownPositions(view)) {
        const float deepest = -distance(point);
        if (deepest > 0) marks.point(point, heat(deepest / kMax), 5, Marks::Depth::OnTop);
    }
}

}  // namespace

OverlayMode penetrationOverlay() {
    return {"penetration", "Penetration",
            "Shows points inside a sphere or capsule. A deeper red is a deeper penetration", drawPenetration,
            80};
}

}  // namespace hairloom::editor
