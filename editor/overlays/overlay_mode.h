// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Things that are not in the picture made visible: roots, guides, spheres, strain … Each is a file of its
// own, NAME.cpp, with one function `OverlayMode nameOverlay()`; the list is made from the names of the files.

#include <QString>
#include <span>
#include <vector>

#include "core/geometry/scalp_mesh.h"
#include "editor/simulation/player.h"
#include "editor/viewport/marks.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

/// What is shown now.
struct OverlayView {
    const Groom& groom;
    const Viewport& viewport;
    const Player& player;
};

struct OverlayMode {
    const char* id;
    const char* title;
    const char* tip;
    void (*draw)(const OverlayView& view, Marks& marks);
    int order = 100;                  ///< in the menu
    std::vector<QString> tools = {};  ///< ids of those that it comes with
    bool onBareHeads = false;         ///< it is there until hair grows
};

/// In order of file name (hairloom_registry).
const std::vector<OverlayMode>& overlayFiles();
/// By their order.
const std::vector<OverlayMode>& overlayModes();

// Helpers that several share.
/// The groom's points where they are shown now: simulated, or at rest.
std::span<const Vec3f> shownPositions(const OverlayView& view);
/// A point of the scalp where it is shown now.
Vec3f shownOnScalp(const OverlayView& view, const SurfacePoint& point);
/// Vertices of the head where they are shown now; empty where it moves as a rigid whole or rests.
std::span<const Vec3f> shownVertices(const OverlayView& view);
/// Green over yellow to red for 0 … 1.
QColor heat(float share);

// Drawn by tools as well.
void drawSpheres(const OverlayView& view, Marks& marks);
/// An arrow from the middle of the view, kWindPixels long for each m/s.
inline constexpr float kWindPixels = 18;
void drawWind(const OverlayView& view, Marks& marks);

}  // namespace hairloom::editor
