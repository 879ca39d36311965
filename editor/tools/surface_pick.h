// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The view in the terms of core/editing, and what lies under the pointer.

#include <QPointF>
#include <optional>

#include "core/editing/picking.h"
#include "core/editing/view.h"
#include "editor/document/qt_document.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

editing::View viewOf(const Viewport& viewport);
Vec2f toPixels(const QPointF& at_px);

/// A place for a brush: on the hair or the head, whichever is nearer, else at the depth of the middle of the
/// view.
struct BrushPlace {
    Vec3f position_ss = Vec3f::Zero();
    Vec3f normal_ss = Vec3f::UnitZ();      ///< of the skin, else towards the eye; unit length
    Vec3f direction_ss = -Vec3f::UnitZ();  ///< into the view; unit length
    std::optional<SurfacePoint> skin;      ///< where the pointer is over the head
};
BrushPlace placeUnder(const QtDocument& document, const Viewport& viewport, const QPointF& at_px);
/// The same for what works on the skin: hair before it does not count.
BrushPlace skinUnder(const QtDocument& document, const Viewport& viewport, const QPointF& at_px);
/// Under the pointer as deep in the view as `point_ws`, whatever is there.
BrushPlace placeAtDepthOf(const Viewport& viewport, const Vec3f& point_ws, const QPointF& at_px);

}  // namespace hairloom::editor
