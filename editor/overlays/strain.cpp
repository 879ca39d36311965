// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawStrain(const OverlayView& view, Marks& marks) {
    constexpr float kMax = 0.01f;
    const Groom& groom = view.groom;
    const auto rest = groom.positions();
    const auto now = shownPositions(view);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p) {
            const float length = (rest[p] - rest[p - 1]).norm();
            if (!(length > 0)) continue;
            const float strain = std::abs((now[p] - now[p - 1]).norm() / length - 1);
            marks.line(now[p - 1], now[p], heat(strain / kMax), 1);
        }
    }
}

}  // namespace

OverlayMode strainOverlay() {
    return {"strain", "Strain",
            "Colours segments by stretch. Green is the authored length, red is 1 % or more", drawStrain, 70};
}

}  // namespace hairloom::editor
