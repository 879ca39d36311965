// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

void drawScalp(const Session& session, Marks& marks) {
    const Groom& groom = session.document.groom();
    if (!groom.scalp) return;
    const QColor colour(80, 160, 255, 90);
    for (const std::uint32_t face : groom.scalpSelection) {
        marks.triangle(
            {shownOnScalp(session, {face, Vec3f::UnitX()}), shownOnScalp(session, {face, Vec3f::UnitY()}),
             shownOnScalp(session, {face, Vec3f::UnitZ()})},
            colour);
    }
}

}  // namespace hairloom::editor
