// SPDX-License-Identifier: GPL-3.0-or-later
// How dense hair grows: what was painted, as a tint of the skin, and the roots there are, by how many lie
// around each.
#include <algorithm>

#include "core/editing/root_grid.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

constexpr float kAround = 0.01f;  // metres

/// Roots within kAround of each root, itself included. Found once for as long as the strands stay.
const std::vector<std::uint32_t>& rootsAround(const Groom& groom) {
    static std::vector<std::uint32_t> counts;
    static std::pair<Version, std::size_t> of{};
    const std::pair<Version, std::size_t> now{groom.offsets.version(), groom.strandCount()};
    if (of == now) return counts;
    of = now;
    editing::RootGrid grid(kAround);
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        grid.add(static_cast<std::uint32_t>(s), groom.strand(s).front());
    counts.assign(groom.strandCount(), 0);
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        counts[s] = static_cast<std::uint32_t>(grid.countWithin(groom.strand(s).front(), kAround));
    return counts;
}

void drawPainted(const OverlayView& view, Marks& marks) {
    const Groom& groom = view.groom;
    if (!groom.scalp || groom.scalpDensity.empty()) return;
    const auto colourOf = [&](std::uint32_t vertex) {
        QColor colour = heat(1 - groom.scalpDensity[vertex]);
        colour.setAlpha(110);
        return colour;
    };
    for (const std::uint32_t face : groom.scalpSelection) {
        const Triangle& corners = groom.scalp->triangles()[face];
        marks.triangle(
            {shownOnScalp(view, {face, Vec3f::UnitX()}), shownOnScalp(view, {face, Vec3f::UnitY()}),
             shownOnScalp(view, {face, Vec3f::UnitZ()})},
            {colourOf(corners[0]), colourOf(corners[1]), colourOf(corners[2])});
    }
}

void drawDensity(const OverlayView& view, Marks& marks) {
    drawPainted(view, marks);
    const Groom& groom = view.groom;
    if (groom.strandCount() == 0) return;
    const std::vector<std::uint32_t>& counts = rootsAround(groom);
    const auto maximum = static_cast<float>(std::max(2u, *std::ranges::max_element(counts)));
    const auto positions = shownPositions(view);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        marks.point(positions[groom.offsets[s]], heat(1 - static_cast<float>(counts[s]) / maximum), 4);
    }
}

}  // namespace

OverlayMode densityOverlay() {
    return {"density",
            "Density",
            "Colours roots by how many are within 1 cm, and shows the painted density. Red is dense",
            drawDensity,
            90,
            {"density_paint"}};
}

}  // namespace hairloom::editor
