// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "core/operations/mask.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

/// Each strand in the colour of the mask that is strongest on it.
void drawMasks(const OverlayView& view, Marks& marks) {
    constexpr float kMin = 0.02f;  // of a mask; less is not drawn
    static const std::array<QColor, kPaintedMasks> kColours = {QColor(240, 90, 60), QColor(60, 200, 90),
                                                               QColor(70, 140, 250), QColor(240, 200, 50)};
    const Groom& groom = view.groom;
    std::array<std::span<const float>, kPaintedMasks> masks;
    for (std::uint32_t m = 0; m < kPaintedMasks; ++m)
        masks[m] = groom.strandAttributes.view<float>(maskAttribute(m + 1));
    const auto positions = shownPositions(view);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        QColor colour;
        float strongest = kMin;
        for (std::size_t m = 0; m < masks.size(); ++m) {
            if (s >= masks[m].size() || masks[m][s] <= strongest) continue;
            strongest = masks[m][s];
            colour = kColours[m];
        }
        if (!colour.isValid()) continue;
        colour.setAlphaF(std::min(strongest, 1.0f));
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p)
            marks.line(positions[p - 1], positions[p], colour, 1);
    }
}

}  // namespace

OverlayMode masksOverlay() {
    return {"masks",   "Masks", "Shows the painted operator masks 1 to 4 in red, green, blue and yellow",
            drawMasks, 105,     {"mask_paint"}};
}

}  // namespace hairloom::editor
