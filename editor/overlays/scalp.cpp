// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawScalp(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    if (!groom.scalp) return;
    const QColor colour(80, 160, 255, 90);
    for (const std::uint32_t face : groom.scalpSelection) {
        marks.triangle(
            {shownOnScalp(view, {face, Vec3f::UnitX()}), shownOnScalp(view, {face, Vec3f::UnitY()}),
             shownOnScalp(view, {face, Vec3f::UnitZ()})},
            colour);
    }
}

}  // namespace

OverlayMode scalpOverlay() {
    return {"scalp",   "Scalp", "Tints the faces where hair grows",
            drawScalp, 10,      {"scalp_paint", "scalp_box", "scalp_lasso"},
            true};
}

}  // namespace hairloom::editor
