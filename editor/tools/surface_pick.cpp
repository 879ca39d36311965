// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/surface_pick.h"

#include "core/editing/document.h"

namespace hairloom::editor {

editing::View viewOf(const Viewport& viewport) {
    const render::Camera camera = viewport.camera().camera();
    const QSizeF size = viewport.viewSize_px();
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

/// Places under the pointer, by how deep they are in the view.
class UnderPointer {
  public:
    UnderPointer(const Viewport& viewport, const QPointF& at_px)
        : ray_(viewport.camera().rayThrough(at_px, viewport.viewSize_px())),
          forward_(viewport.camera().forward_ws()) {}

    float depthOf(const Vec3f& point_ws) const { return (point_ws - ray_.origin_ws).dot(forward_); }
    /// Facing the view.
    BrushPlace at(float depth) const {
        BrushPlace place;
        place.direction_ss = ray_.direction_ws;
        place.normal_ss = -forward_;
        place.position_ss = ray_.origin_ws + ray_.direction_ws * (depth / ray_.direction_ws.dot(forward_));
        return place;
    }

  private:
    Ray ray_;
    Vec3f forward_;
};

BrushPlace placeAt(const QtDocument& shown, const Viewport& viewport, const QPointF& at_px, bool onHair) {
    const editing::Document& document = shown.editing();
    const editing::View view = viewOf(viewport);
    const UnderPointer pointer(viewport, at_px);
    BrushPlace place = pointer.at(pointer.depthOf(viewport.camera().target_ws()));
    float skinDepth = 0;
    if (const auto hit = editing::pickHead(document.surface(), view, toPixels(at_px))) {
        place = pointer.at(pointer.depthOf(hit->position));
        place.skin = hit->surface;
        place.normal_ss = document.groom().scalp->normalAt(hit->surface.triangle, hit->surface.barycentric);
        skinDepth = pointer.depthOf(hit->position);
    }
    if (!onHair && place.skin) return place;
    const auto strand =
        editing::pickStrand(document.groom(), document.bounds(), document.surface(), view, toPixels(at_px));
    if (!strand) return place;
    const float depth = pointer.depthOf(strand->position_ss);
    if (place.skin && depth >= skinDepth) return place;
    const auto skin = place.skin;
    place = pointer.at(depth);
    place.skin = skin;
    return place;
}

}  // namespace

BrushPlace placeUnder(const QtDocument& document, const Viewport& viewport, const QPointF& at_px) {
    return placeAt(document, viewport, at_px, true);
}

BrushPlace skinUnder(const QtDocument& document, const Viewport& viewport, const QPointF& at_px) {
    return placeAt(document, viewport, at_px, false);
}

BrushPlace placeAtDepthOf(const Viewport& viewport, const Vec3f& point_ws, const QPointF& at_px) {
    const UnderPointer pointer(viewport, at_px);
    return pointer.at(pointer.depthOf(point_ws));
}

}  // namespace hairloom::editor
