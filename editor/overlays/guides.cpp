// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawGuides(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto positions = shownPositions(view);
    const auto isGuide = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
    const QColor colour(110, 190, 255, 200);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (!isGuide.empty() && isGuide[s] == 0) continue;
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p) {
            marks.line(positions[p - 1], positions[p], colour, 1);
        }
    }
}

}  // namespace

OverlayMode guidesOverlay() {
    return {"guides", QT_TR_NOOP("Guides"), QT_TR_NOOP("The strands that are simulated, as lines"),
            drawGuides, 30};
}

}  // namespace hairloom::editor
