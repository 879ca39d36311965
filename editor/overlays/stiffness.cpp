// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

/// Strands of their own stiffness, blue where they are softer than the settings and red where stiffer.
void drawStiffness(const OverlayView& view, Marks& marks) {
    constexpr float kFull = 16;  // times or a part of the settings' stiffness that has its whole colour
    const Groom& groom = view.groom;
    const auto stiffness = groom.strandAttributes.view<float>(attribute::kStiffness);
    const auto positions = shownPositions(view);
    for (std::size_t s = 0; s < stiffness.size(); ++s) {
        if (stiffness[s] == 1) continue;
        const float share =
            std::clamp(std::log(std::max(stiffness[s], 1 / kFull)) / std::log(kFull), -1.0f, 1.0f);
        QColor colour = share < 0 ? QColor(70, 140, 250) : QColor(240, 90, 60);
        colour.setAlphaF(std::max(std::abs(share), 0.25f));
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p)
            marks.line(positions[p - 1], positions[p], colour, 1);
    }
}

}  // namespace

OverlayMode stiffnessOverlay() {
    return {"stiffness", "Stiffness", "Shows softer strands in blue and stiffer ones in red", drawStiffness,
            106};
}

}  // namespace hairloom::editor
