// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

/// What is this much of the brightness is left to the guides farthest away, and to those that run along the
/// view.
constexpr float kFarthest = 0.35f, kEndOn = 0.4f;

QColor dimmed(const QColor& colour, float share) {
    return QColor::fromRgbF(colour.redF() * share, colour.greenF() * share, colour.blueF() * share,
                            colour.alphaF());
}

/// Lit as a thread is by a light at the eye, and the dimmer the farther away.
void drawGuides(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    const auto positions = shownPositions(view);
    const auto isGuide = groom.strandAttributes.view<std::uint8_t>(attribute::kGuide);
    const auto selected = groom.strandAttributes.view<std::uint8_t>(attribute::kSelected);
    const QColor colour(130, 205, 255), ofSelected(255, 170, 60);
    const Vec3f forward = view.viewport.camera().forward_ws();
    float nearest = std::numeric_limits<float>::max(), farthest = std::numeric_limits<float>::lowest();
    for (const Vec3f& point : positions) {
        nearest = std::min(nearest, point.dot(forward));
        farthest = std::max(farthest, point.dot(forward));
    }
    const float depth = std::max(farthest - nearest, 1e-6f);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (!isGuide.empty() && isGuide[s] == 0) continue;
        const bool isSelected = !selected.empty() && selected[s] != 0;
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p) {
            const Vec3f &from = positions[p - 1], &to = positions[p];
            const float along = std::abs((to - from).normalized().dot(forward));
            const float lit = 1 - (1 - kEndOn) * along * along;
            const float away = (0.5f * (from + to).dot(forward) - nearest) / depth;
            marks.line(from, to, dimmed(isSelected ? ofSelected : colour, lit * (1 - (1 - kFarthest) * away)),
                       isSelected ? 1.5f : 1.0f);
        }
    }
}

}  // namespace

OverlayMode guidesOverlay() {
    return {"guides", "Guides",
            "Shows the simulated strands as lines, dimmer where hidden. Selected strands are orange",
            drawGuides, 30};
}

}  // namespace hairloom::editor
