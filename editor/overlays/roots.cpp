// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawRoots(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto positions = shownPositions(view);
    const QColor colour(255, 196, 64);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) marks.point(positions[groom.offsets[s]], colour, 4);
}

}  // namespace

OverlayMode rootsOverlay() {
    return {"roots", "Roots", "Shows a dot at each root", drawRoots, 20};
}

}  // namespace hairloom::editor
