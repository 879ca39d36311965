// SPDX-License-Identifier: GPL-3.0-or-later
// What pointer, tablet and keys do in the viewport: they move the view, or are the tool's.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPlatformSurfaceEvent>
#include <cmath>

#include "editor/viewport/viewport.h"

namespace hairloom::editor {
namespace {

constexpr float kZoomPerPixel = 0.006f;
constexpr float kZoomPerWheelUnit = 0.0012f;  // an eighth of a degree

}  // namespace

Viewport::Move Viewport::viewMove(Qt::MouseButton button, Qt::KeyboardModifiers modifiers) const {
    if (preferences_.orbitStyle() == OrbitStyle::Blender) {
        if (button == Qt::MiddleButton) {
            if (modifiers & Qt::ShiftModifier) return Move::Pan;
            return modifiers & Qt::ControlModifier ? Move::Zoom : Move::Turn;
        }
    } else if (modifiers & Qt::AltModifier) {
        if (button == Qt::LeftButton) return Move::Turn;
        if (button == Qt::MiddleButton) return Move::Pan;
        if (button == Qt::RightButton) return Move::Zoom;
    }
    if (button == Qt::MiddleButton) return Move::Pan;
    if (button == Qt::RightButton) return Move::Turn;
    return tool_ ? Move::None : Move::Turn;
}

Pointer Viewport::pointerAt(const QPointF& at_px, Qt::MouseButton button,
                            Qt::KeyboardModifiers modifiers) const {
    return {at_px, button, modifiers, pressure_};
}

bool Viewport::mousePress(const QMouseEvent& event) {
    last_px_ = event.position();
    if (overSplit(event.position()) && event.button() == Qt::LeftButton) {
        move_ = Move::Split;
        return true;
    }
    move_ = viewMove(event.button(), event.modifiers());
    if (move_ != Move::None) return true;
    if (!tool_ || event.button() != Qt::LeftButton) return false;
    toolPressed_ = true;
    tool_->press(pointerAt(event.position(), event.button(), event.modifiers()));
    return true;
}

bool Viewport::mouseMove(const QMouseEvent& event) {
    if (move_ != Move::None) {
        dragView(event.position());
        return true;
    }
    if (canvas_) canvas_->setCursor(overSplit(event.position()) ? Qt::SplitHCursor : Qt::ArrowCursor);
    if (!tool_) return false;
    const Pointer pointer = pointerAt(event.position(), Qt::NoButton, event.modifiers());
    toolPressed_ ? tool_->drag(pointer) : tool_->hover(pointer);
    return true;
}

bool Viewport::mouseRelease(const QMouseEvent& event) {
    if (move_ != Move::None) {
        move_ = Move::None;
        return true;
    }
    if (!toolPressed_ || event.button() != Qt::LeftButton) return false;
    toolPressed_ = false;
    if (tool_) tool_->release(pointerAt(event.position(), event.button(), event.modifiers()));
    redraw();
    return true;
}

void Viewport::dragView(const QPointF& to_px) {
    const QPointF by = to_px - last_px_;
    last_px_ = to_px;
    switch (move_) {
        case Move::Turn:
            camera_.turn(by);
            break;
        case Move::Pan:
            camera_.move(by, viewSize_px());
            break;
        case Move::Zoom:
            camera_.zoom(std::exp(kZoomPerPixel * static_cast<float>(by.x() - by.y())));
            break;
        case Move::Split:
            setSplit(static_cast<float>(to_px.x() / std::max(width(), 1)));
            return;
        case Move::None:
            return;
    }
    redraw(true);
}

bool Viewport::overSplit(const QPointF& at_px) const {
    constexpr double kReach_px = 6;
    return comparison_ && canvas_ && std::abs(at_px.x() - static_cast<double>(split_) * width()) < kReach_px;
}

bool Viewport::tablet(const QTabletEvent& event) {
    const double pressed = event.type() == QEvent::TabletRelease ? 1.0 : event.pressure();
    pressure_ = std::pow(std::clamp(pressed, 0.0, 1.0), preferences_.tabletCurve());
    // Qt makes a mouse event of it, which carries the stroke on.
    return false;
}

bool Viewport::keyPress(const QKeyEvent& event) {
    if (event.key() == Qt::Key_Escape && tool_) {
        tool_->cancel();
        toolPressed_ = false;
        redraw();
        return true;
    }
    if (tool_ && tool_->key(event.key(), event.modifiers())) return true;
    if (window_) Q_EMIT keyPressed(event.key(), event.modifiers());
    return window_ != nullptr;
}

bool Viewport::eventFilter(QObject* object, QEvent* event) {
    switch (event->type()) {
        case QEvent::MouseButtonPress:
            return mousePress(*static_cast<QMouseEvent*>(event));
        case QEvent::MouseMove:
            return mouseMove(*static_cast<QMouseEvent*>(event));
        case QEvent::MouseButtonRelease:
            return mouseRelease(*static_cast<QMouseEvent*>(event));
        case QEvent::Wheel:
            camera_.zoom(std::exp(kZoomPerWheelUnit *
                                  static_cast<float>(static_cast<QWheelEvent*>(event)->angleDelta().y())));
            redraw(true);
            return true;
        case QEvent::TabletPress:
        case QEvent::TabletMove:
        case QEvent::TabletRelease:
            return tablet(*static_cast<QTabletEvent*>(event));
        case QEvent::KeyPress:
            return keyPress(*static_cast<QKeyEvent*>(event));
        case QEvent::Leave:
            if (tool_ && !toolPressed_) tool_->leave();
            break;
        case QEvent::Expose:
            redraw();
            break;
        case QEvent::PlatformSurface:
            surfaceChanged(static_cast<QPlatformSurfaceEvent*>(event)->surfaceEventType() ==
                           QPlatformSurfaceEvent::SurfaceCreated);
            break;
        default:
            break;
    }
    return QWidget::eventFilter(object, event);
}

}  // namespace hairloom::editor
