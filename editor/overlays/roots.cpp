// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

void drawRoots(const Session& session, Marks& marks) {
    const Groom& groom = session.document.groom();
    const auto positions = shownPositions(session);
    const QColor colour(255, 196, 64);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) marks.point(positions[groom.offsets[s]], colour, 4);
}

}  // namespace hairloom::editor
