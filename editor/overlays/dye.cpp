// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/point_dye.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

void drawDye(const OverlayView& view, Marks& marks) {
    constexpr float kMin = 0.02f;  // of the mask; less is not drawn
    const Groom& groom = view.groom;
    const std::vector<float> mask = pointDyes(groom);
    const auto positions = shownPositions(view);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p) {
            const float share = 0.5f * (mask[p - 1] + mask[p]);
            if (share < kMin) continue;
            marks.line(positions[p - 1], positions[p], QColor::fromRgbF(0.95f, 0.25f, 0.75f, share), 1);
        }
    }
}

}  // namespace

OverlayMode dyeOverlay() {
    return {"dye", "Dye", "Shows the painted dye mask in pink", drawDye, 100, {"dye_paint"}};
}

}  // namespace hairloom::editor
