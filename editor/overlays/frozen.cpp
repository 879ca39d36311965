// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawFrozen(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto frozen = groom.strandAttributes.view<std::uint8_t>(attribute::kFrozen);
    if (frozen.empty()) return;
    const auto positions = shownPositions(view);
    const QColor ice(150, 225, 255, 200);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (frozen[s] == 0) continue;
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p)
            marks.line(positions[p - 1], positions[p], ice, 1);
    }
}

}  // namespace

OverlayMode frozenOverlay() {
    return {"frozen",   "Frozen", "Shows hair that brushes do not affect, in ice blue",
            drawFrozen, 35,       {"freeze"}};
}

}  // namespace hairloom::editor
