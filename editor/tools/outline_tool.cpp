// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/outline_tool.h"

#include "editor/tools/surface_pick.h"

namespace hairloom::editor {
namespace {

constexpr double kClick_px = 4;

editing::Choice choiceOf(Qt::KeyboardModifiers modifiers) {
    if (modifiers & Qt::ControlModifier) return editing::Choice::Remove;
    return modifiers & Qt::ShiftModifier ? editing::Choice::Add : editing::Choice::Replace;
}

}  // namespace

OutlineTool::OutlineTool(const ToolParts& parts, Shape shape, ToolInfo info)
    : document_(parts.document),
      preferences_(parts.preferences),
      player_(parts.player),
      viewport_(parts.viewport),
      shape_(shape),
      info_(std::move(info)) {}

void OutlineTool::activate() {
    if (player_.hasFrame()) player_.reset();
}

void OutlineTool::press(const Pointer& pointer) {
    path_px_ = {pointer.at_px};
}

void OutlineTool::drag(const Pointer& pointer) {
    if (path_px_.empty()) return;
    path_px_.push_back(pointer.at_px);
    Q_EMIT updated();
}

void OutlineTool::release(const Pointer& pointer) {
    if (path_px_.empty()) return;
    path_px_.push_back(pointer.at_px);
    const editing::Choice choice = choiceOf(pointer.modifiers);
    QRectF extent(path_px_.front(), QSizeF());
    for (const QPointF& at : path_px_) {
        extent.setCoords(std::min(extent.left(), at.x()), std::min(extent.top(), at.y()),
                         std::max(extent.right(), at.x()), std::max(extent.bottom(), at.y()));
    }
    if (std::max(extent.width(), extent.height()) < kClick_px) {
        click(pointer.at_px, choice);
    } else {
        std::vector<Vec2f> corners;
        for (const QPointF& at : corners_px()) corners.push_back(toPixels(at));
        choose(editing::ScreenRegion::lasso(std::move(corners)), choice);
    }
    cancel();
}

void OutlineTool::cancel() {
    path_px_.clear();
    Q_EMIT updated();
}

std::vector<QPointF> OutlineTool::corners_px() const {
    if (shape_ == Shape::Lasso || path_px_.size() < 2) return path_px_;
    const QPointF a = path_px_.front(), b = path_px_.back();
    return {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
}

void OutlineTool::draw(Marks& marks) const {
    if (path_px_.empty()) return;
    const auto corners = corners_px();
    marks.path(corners, true, QColor(255, 255, 255, 220), viewport_.camera(), viewport_.viewSize_px());
}

}  // namespace hairloom::editor
