// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera that a person moves around the head: turn, move, zoom, and standard views.

#include <QPointF>
#include <QSizeF>
#include <optional>

#include "core/base/math.h"
#include "core/render/camera.h"

namespace hairloom::editor {

struct Ray {
    Vec3f origin_ws;
    Vec3f direction_ws;  ///< unit length
};

class OrbitCamera {
  public:
    /// Pixels that the pointer went; the head follows the hand.
    void turn(const QPointF& by_px);
    void move(const QPointF& by_px, const QSizeF& view_px);
    /// Above 1 comes nearer.
    void zoom(float factor);
    /// Degrees about the vertical.
    void spin(float degrees);
    /// Looks along a standard view, keeping what is in the middle.
    void look(render::View view);
    /// Sees all of the box, from where it looks now.
    void frame(const Box3f& bounds_ws, float aspect);
    void setOrthographic(bool on) { orthographic_ = on; }
    bool isOrthographic() const { return orthographic_; }

    render::Camera camera() const;
    Ray rayThrough(const QPointF& at_px, const QSizeF& view_px) const;
    /// Nothing for points behind the eye.
    std::optional<QPointF> project(const Vec3f& point_ws, const QSizeF& view_px) const;
    /// Metres that one pixel covers at a point.
    float metresPerPixel(const Vec3f& point_ws, const QSizeF& view_px) const;
    Vec3f right_ws() const;
    Vec3f up_ws() const;
    /// Unit length, from the eye into the picture.
    Vec3f forward_ws() const;
    const Vec3f& target_ws() const { return target_ws_; }

  private:
    /// Metres that the picture is high at the target.
    float heightAtTarget() const;

    Vec3f target_ws_{0, 1.65f, 0};
    float distance_ = 1.0f;  ///< metres from the target, at kFov
    float yaw_ = 0.6f;       ///< radians about +Y; 0 looks from the front
    float pitch_ = 0.1f;     ///< radians, above the horizon
    bool orthographic_ = false;
};

}  // namespace hairloom::editor
