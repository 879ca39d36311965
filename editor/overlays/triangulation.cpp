// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

void drawTriangulation(const Session& session, Marks& marks) {
    const Groom& groom = session.document.groom();
    const auto positions = shownPositions(session);
    const QColor colour(120, 230, 160, 200);
    for (const Triangle& triangle : groom.triangulation.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
            // An inner edge belongs to two triangles, which see it in opposite directions.
            if (a < b) marks.line(positions[groom.offsets[a]], positions[groom.offsets[b]], colour, 1);
        }
    }
}

}  // namespace hairloom::editor
