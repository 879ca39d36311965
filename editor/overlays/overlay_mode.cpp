// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {

const std::vector<OverlayMode>& overlayModes() {
    static const std::vector<OverlayMode> sorted = [] {
        std::vector<OverlayMode> list = overlayFiles();
        std::ranges::stable_sort(list, {}, &OverlayMode::order);
        return list;
    }();
    return sorted;
}

std::span<const Vec3f> shownPositions(const OverlayView& view) {
    const Groom& groom = view.groom;
    const auto& pose = view.viewport.pose();
    view.viewport.wantPositions();
    if (pose && pose->positions_ws.size() == groom.pointCount()) return pose->positions_ws;
    return groom.positions();
}

std::span<const Vec3f> shownVertices(const OverlayView& view) {
    const auto& pose = view.viewport.pose();
    if (!pose) return {};
    return pose->head.scalpPositions_ws;
}

Vec3f shownOnScalp(const OverlayView& view, const SurfacePoint& point) {
    const Groom& groom = view.groom;
    const auto vertices = shownVertices(view);
    if (vertices.size() == groom.scalp->vertexCount()) {
        const Triangle& corners = groom.scalp->triangles()[point.triangle];
        return point.barycentric[0] * vertices[corners[0]] + point.barycentric[1] * vertices[corners[1]] +
               point.barycentric[2] * vertices[corners[2]];
    }
    const Vec3f rest = groom.scalp->pointAt(point.triangle, point.barycentric);
    const auto& pose = view.viewport.pose();
    return pose ? Vec3f(pose->head.head_ws * rest) : rest;
}

QColor heat(float share) {
    // From green (hue 120°) to red (0°).
    return QColor::fromHsvF((1 - std::clamp(share, 0.0f, 1.0f)) / 3, 0.85f, 0.95f);
}

}  // namespace hairloom::editor
