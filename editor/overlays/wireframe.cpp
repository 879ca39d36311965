// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawWireframe(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    if (!groom.scalp) return;
    const auto& pose = view.viewport.pose();
    const auto moved = shownVertices(view);
    const auto at = [&](std::uint32_t vertex) -> Vec3f {
        if (moved.size() == groom.scalp->vertexCount()) return moved[vertex];
        const Vec3f& rest = groom.scalp->positions()[vertex];
        return pose ? Vec3f(pose->head.head_ws * rest) : rest;
    };
    const QColor colour(20, 22, 26, 150);
    const auto& mesh = groom.scalp->connectivity();
    for (const auto edge : mesh.edges()) {
        const auto half = mesh.halfedge_handle(edge, 0);
        marks.line(at(static_cast<std::uint32_t>(mesh.from_vertex_handle(half).idx())),
                   at(static_cast<std::uint32_t>(mesh.to_vertex_handle(half).idx())), colour, 1);
    }
}

}  // namespace

OverlayMode wireframeOverlay() {
    return {"wireframe", "Wireframe", "Shows the edges of the head mesh", drawWireframe, 60};
}

}  // namespace hairloom::editor
