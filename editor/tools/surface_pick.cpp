// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/surface_pick.h"

#include "core/editing/document.h"
#include "editor/session.h"

namespace hairloom::editor {

editing::View viewOf(const Session& session) {
    const render::Camera camera = session.viewport->camera().camera();
    const QSizeF size = session.viewport->viewSize_px();
    const float away = (camera.target_ws - camera.eye_ws).norm();
    const auto aspect = static_cast<float>(size.width() / std::max(size.height(), 1.0));
    const float nearPlane = camera.isOrthographic() ? -20 * away : 0.05f * away;
    return {render::viewMatrix(camera),
            render::projectionMatrix(camera, aspect, nearPlane, 20 * away),
            {static_cast<float>(size.width()), static_cast<float>(size.height())}};
}

Vec2f toPixels(const QPointF& at_px) {
    return {static_cast<float>(at_px.x()), static_cast<float>(at_px.y())};
}

namespace {

BrushPlace placeAt(const Session& session, const QPointF& at_px, bool onHair) {
    const editing::Document& document = session.document.editing();
    const editing::View view = viewOf(session);
    const OrbitCamera& camera = session.viewport->camera();
    const Ray ray = camera.rayThrough(at_px, session.viewport->viewSize_px());
    const Vec3f forward = camera.forward_ws();
    BrushPlace place;
    place.direction_ss = ray.direction_ws;
    place.normal_ss = -forward;
    const float slant = ray.direction_ws.dot(forward);
    float depth = (camera.target_ws() - ray.origin_ws).dot(forward);
    if (const auto hit = editing::pickHead(document.surface(), view, toPixels(at_px))) {
        depth = (hit->position - ray.origin_ws).dot(forward);
        place.skin = hit->surface;
        place.normal_ss = document.groom().scalp->normalAt(hit->surface.triangle, hit->surface.barycentric);
    }
    if (!onHair && place.skin) {
        place.position_ss = ray.origin_ws + ray.direction_ws * (depth / slant);
        return place;
    }
    const auto strand =
        editing::pickStrand(document.groom(), document.bounds(), document.surface(), view, toPixels(at_px));
    if (strand) {
        const float strandDepth = (strand->position_ss - ray.origin_ws).dot(forward);
        if (!place.skin || strandDepth < depth) {
            depth = strandDepth;
            place.normal_ss = -forward;
        }
    }
    place.position_ss = ray.origin_ws + ray.direction_ws * (depth / slant);
    return place;
}

}  // namespace

BrushPlace placeUnder(const Session& session, const QPointF& at_px) {
    return placeAt(session, at_px, true);
}

BrushPlace skinUnder(const Session& session, const QPointF& at_px) {
    return placeAt(session, at_px, false);
}

BrushPlace placeAtDepthOf(const Session& session, const Vec3f& point_ws, const QPointF& at_px) {
    const OrbitCamera& camera = session.viewport->camera();
    const Ray ray = camera.rayThrough(at_px, session.viewport->viewSize_px());
    const Vec3f forward = camera.forward_ws();
    BrushPlace place;
    place.direction_ss = ray.direction_ws;
    place.normal_ss = -forward;
    const float depth = (point_ws - ray.origin_ws).dot(forward);
    place.position_ss = ray.origin_ws + ray.direction_ws * (depth / ray.direction_ws.dot(forward));
    return place;
}

}  // namespace hairloom::editor
