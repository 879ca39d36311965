// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Things that are not in the picture made visible: roots, guides, spheres, strain … Each is a file of its
// own; registry.cpp lists them.

#include <QString>
#include <span>

#include "core/geometry/scalp_mesh.h"
#include "editor/viewport/marks.h"

namespace hairloom::editor {

class Session;

struct OverlayMode {
    const char* id;
    const char* title;
    const char* tip;
    void (*draw)(const Session& session, Marks& marks);
};

std::span<const OverlayMode> overlayModes();

// Helpers that several share.
/// The groom's points where they are shown now: simulated, or at rest.
std::span<const Vec3f> shownPositions(const Session& session);
/// A point of the scalp where it is shown now.
Vec3f shownOnScalp(const Session& session, const SurfacePoint& point);
/// Vertices of the head where they are shown now; empty where it moves as a rigid whole or rests.
std::span<const Vec3f> shownVertices(const Session& session);
/// Green over yellow to red for 0 … 1.
QColor heat(float share);

void drawRoots(const Session& session, Marks& marks);
void drawGuides(const Session& session, Marks& marks);
void drawTriangulation(const Session& session, Marks& marks);
void drawSpheres(const Session& session, Marks& marks);
void drawWireframe(const Session& session, Marks& marks);
void drawScalp(const Session& session, Marks& marks);
void drawStrain(const Session& session, Marks& marks);
void drawPenetration(const Session& session, Marks& marks);
void drawDensity(const Session& session, Marks& marks);
void drawDye(const Session& session, Marks& marks);
void drawEffectCost(const Session& session, Marks& marks);
/// An arrow from the middle of the view, kWindPixels long for each m/s.
inline constexpr float kWindPixels = 18;
void drawWind(const Session& session, Marks& marks);

}  // namespace hairloom::editor
