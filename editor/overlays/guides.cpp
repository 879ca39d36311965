// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

void drawGuides(const Session& session, Marks& marks) {
    const Groom& groom = session.document.groom();
    const auto positions = shownPositions(session);
    const auto isGuide = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
    const QColor colour(110, 190, 255, 200);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (!isGuide.empty() && isGuide[s] == 0) continue;
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p) {
            marks.line(positions[p - 1], positions[p], colour, 1);
        }
    }
}

}  // namespace hairloom::editor
