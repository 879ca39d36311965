// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the scalp's rest space is seen: between pixels and rays.

#include <optional>

#include "core/base/math.h"

namespace hairloom::editing {

struct Ray {
    Vec3f origin_ss;
    Vec3f direction_ss;  ///< unit length
};

/// A point on the screen.
struct ScreenPoint {
    Vec2f px;     ///< from the top left corner
    float depth;  ///< metres along the view, > 0 in front of the eye
};

/// A perspective or orthographic view.
class View {
  public:
    /// `view` is right-handed (−Z forward), `projection` gives clip space of depth 0 … 1 as
    /// render::projectionMatrix() does, both from the scalp's rest space. `size_px` is that of the picture.
    /// The projection can be inverted.
    View(const Mat4f& view, const Mat4f& projection, const Vec2f& size_px);

    /// Nothing for a point beside or behind the eye.
    std::optional<ScreenPoint> project(const Vec3f& point_ss) const;
    /// Through the middle of what is at this place of the picture; from the eye, or from the near plane.
    Ray rayAt(const Vec2f& px) const;
    /// Width in metres of one pixel at a depth.
    float metresPerPixel(float depth) const;
    const Vec2f& size_px() const { return size_; }

  private:
    Mat4f view_;
    Mat4f viewProjection_;
    Mat4f inverse_;
    Vec2f size_;
    Vec3f eye_;
    Vec3f forward_;
    bool isPerspective_;
    float scaleY_;  ///< of the projection
};

}  // namespace hairloom::editing
