// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What tools and display options draw over the picture, gathered into the batches that the renderer takes.

#include <QColor>
#include <QPointF>
#include <QSizeF>
#include <array>
#include <span>

#include "core/render/overlay.h"
#include "editor/viewport/orbit_camera.h"

namespace hairloom::editor {

class Marks {
  public:
    enum class Depth {
        Hidden,  ///< behind the head, where that is in front
        OnTop,
    };

    void line(const Vec3f& a_ws, const Vec3f& b_ws, const QColor& colour, float width_px = 1.5f,
              Depth depth = Depth::Hidden);
    void point(const Vec3f& at_ws, const QColor& colour, float diameter_px = 5, Depth depth = Depth::Hidden);
    void triangle(const std::array<Vec3f, 3>& corners_ws, const QColor& colour, Depth depth = Depth::Hidden);
    /// One colour a corner.
    void triangle(const std::array<Vec3f, 3>& corners_ws, const std::array<QColor, 3>& colours,
                  Depth depth = Depth::Hidden);
    /// Around `centre_ws`, at right angles to `normal_ws`; metres.
    void circle(const Vec3f& centre_ws, const Vec3f& normal_ws, float radius, const QColor& colour,
                float width_px = 1.5f, Depth depth = Depth::Hidden);
    /// Lines on the screen, as lassos and boxes are.
    void path(std::span<const QPointF> points_px, bool closed, const QColor& colour,
              const OrbitCamera& camera, const QSizeF& view_px);

    const render::Overlay& overlay() const { return overlay_; }

  private:
    render::OverlayBatch& batch(render::OverlayShape shape, float size, Depth depth);

    render::Overlay overlay_;
};

}  // namespace hairloom::editor
