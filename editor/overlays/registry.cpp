// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "editor/overlays/overlay_mode.h"
#include "editor/session.h"

namespace hairloom::editor {

std::span<const OverlayMode> overlayModes() {
    static constexpr OverlayMode kModes[] = {
        {"scalp", QT_TR_NOOP("Scalp"), QT_TR_NOOP("Tints the faces that carry hair"), drawScalp},
        {"roots", QT_TR_NOOP("Roots"), QT_TR_NOOP("A dot at the root of each strand"), drawRoots},
        {"guides", QT_TR_NOOP("Guides"), QT_TR_NOOP("The strands that are simulated, as lines"), drawGuides},
        {"triangulation", QT_TR_NOOP("Root triangles"),
         QT_TR_NOOP("The triangles between roots that follow hairs are blended in"), drawTriangulation},
        {"spheres", QT_TR_NOOP("Spheres"), QT_TR_NOOP("The spheres that strands collide with"), drawSpheres},
        {"wireframe", QT_TR_NOOP("Wireframe"), QT_TR_NOOP("Edges of the head"), drawWireframe},
        {"strain", QT_TR_NOOP("Strain"),
         QT_TR_NOOP("Segments by how far they are stretched: green as authored, red by 1 % and more"),
         drawStrain},
        {"penetration", QT_TR_NOOP("Penetration"),
         QT_TR_NOOP("Points inside a sphere: red by 2 mm and deeper"), drawPenetration},
        {"density", QT_TR_NOOP("Density"),
         QT_TR_NOOP("Roots by how many lie within 1 cm, and the density that was painted: red is dense"),
         drawDensity},
        {"dye", QT_TR_NOOP("Dye"),
         QT_TR_NOOP("Where hair is dyed, as painted: strands in pink by the mask's share"), drawDye},
        {"effectCost", QT_TR_NOOP("Effect cost"),
         QT_TR_NOOP("Strands by what the simulation spends on each while it plays: red is the dearest, grey "
                    "rests and costs nothing"),
         drawEffectCost},
        {"wind", QT_TR_NOOP("Wind"), QT_TR_NOOP("An arrow where the wind blows to; longer is stronger"),
         drawWind},
    };
    return kModes;
}

std::span<const Vec3f> shownPositions(const Session& session) {
    const Groom& groom = session.document.groom();
    const auto& pose = session.viewport->pose();
    if (pose && pose->positions_ws.size() == groom.pointCount()) return pose->positions_ws;
    return groom.positions();
}

std::span<const Vec3f> shownVertices(const Session& session) {
    const auto& pose = session.viewport->pose();
    if (!pose) return {};
    return pose->head.scalpPositions_ws;
}

Vec3f shownOnScalp(const Session& session, const SurfacePoint& point) {
    const Groom& groom = session.document.groom();
    const auto vertices = shownVertices(session);
    if (vertices.size() == groom.scalp->vertexCount()) {
        const Triangle& corners = groom.scalp->triangles()[point.triangle];
        return point.barycentric[0] * vertices[corners[0]] + point.barycentric[1] * vertices[corners[1]] +
               point.barycentric[2] * vertices[corners[2]];
    }
    const Vec3f rest = groom.scalp->pointAt(point.triangle, point.barycentric);
    const auto& pose = session.viewport->pose();
    return pose ? Vec3f(pose->head.head_ws * rest) : rest;
}

QColor heat(float share) {
    // From green (hue 120°) to red (0°).
    return QColor::fromHsvF((1 - std::clamp(share, 0.0f, 1.0f)) / 3, 0.85f, 0.95f);
}

}  // namespace hairloom::editor
