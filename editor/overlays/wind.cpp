// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {

void drawWind(const OverlayView& view, Marks& marks) {
    constexpr float kFastest = 25;  // m/s that the arrow still grows for
    const auto& settings = view.groom.simulation;
    const OrbitCamera& camera = view.viewport.camera();
    const Vec3f direction(settings.windDirection.x, settings.windDirection.y, settings.windDirection.z);
    const Vec3f from = camera.target_ws();
    const QColor colour(120, 200, 255);
    marks.point(from, colour, 9, Marks::Depth::OnTop);
    if (settings.windSpeed <= 0 || direction.norm() < 1e-6f) return;
    const float metresPerPixel = camera.metresPerPixel(from, view.viewport.viewSize_px());
    const Vec3f along = direction.normalized();
    const Vec3f to = from + metresPerPixel * kWindPixels * std::min(settings.windSpeed, kFastest) * along;
    // A cone, so that the arrow shows where it points towards the eye and away from it.
    const float head = metresPerPixel * 22;
    const Vec3f u = along.unitOrthogonal(), v = along.cross(u);
    const Vec3f base = to - head * along;
    marks.line(from, base, QColor(0, 0, 0, 120), 6, Marks::Depth::OnTop);
    marks.line(from, base, colour, 3, Marks::Depth::OnTop);
    constexpr int kSides = 20;
    const auto rim = [&](int i) -> Vec3f {
        const float angle = 2 * kPi * static_cast<float>(i) / kSides;
        return base + 0.38f * head * (std::cos(angle) * u + std::sin(angle) * v);
    };
    for (int i = 0; i < kSides; ++i) {
        // Lit from above.
        const float shade = 0.75f + 0.25f * (0.5f * (rim(i) + rim(i + 1)) - base).normalized().y();
        const QColor side = QColor::fromRgbF(0.47f * shade, 0.78f * shade, shade);
        marks.triangle({to, rim(i), rim(i + 1)}, side, Marks::Depth::OnTop);
    }
}

OverlayMode windOverlay() {
    return {"wind", "Wind", "Shows wind direction as arrows. Longer arrows are stronger wind", drawWind, 120};
}

}  // namespace hairloom::editor
