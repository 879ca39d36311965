// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawTriangulation(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto positions = shownPositions(view);
    const QColor colour(120, 230, 160, 200);
    for (const Triangle& triangle : groom.triangulation.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
            // An inner edge belongs to two triangles, which see it in opposite directions.
            if (a < b) marks.line(positions[groom.offsets[a]], positions[groom.offsets[b]], colour, 1);
        }
    }
}

}  // namespace

OverlayMode triangulationOverlay() {
    return {"triangulation", "Root triangles",
            "Shows the triangles between roots in which hairs are interpolated", drawTriangulation, 40};
}

}  // namespace hairloom::editor
