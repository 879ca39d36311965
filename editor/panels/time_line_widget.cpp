// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/time_line_widget.h"

#include <QWheelEvent>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr std::int64_t kPage = 10;  ///< frames
constexpr double kZoomPerNotch = 0.8, kPanPerNotch = 0.1;
constexpr double kNotch = 120;  ///< of a wheel, in Qt's eighths of a degree

/// Keys that act here and run no shortcut of the window.
bool isTimeLineKey(const QKeyEvent& key) {
    switch (key.key()) {
        case Qt::Key_Left:
        case Qt::Key_Right:
        case Qt::Key_Up:
        case Qt::Key_Down:
        case Qt::Key_PageUp:
        case Qt::Key_PageDown:
        case Qt::Key_Home:
        case Qt::Key_End:
        case Qt::Key_Delete:
        case Qt::Key_Backspace:
        case Qt::Key_Return:
        case Qt::Key_Enter:
        case Qt::Key_Escape:
            return true;
        case Qt::Key_A:
        case Qt::Key_D:
            return key.modifiers() == Qt::ControlModifier;
        default:
            return false;
    }
}

}  // namespace

TimeLineWidget::TimeLineWidget(TimeLineView& view, const char* name, const QString& spoken, QWidget* parent)
    : QWidget(parent), view_(view) {
    setObjectName(name);
    setAccessibleName(spoken);
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    connect(&view_, &TimeLineView::changed, this, qOverload<>(&QWidget::update));
    connect(&view_, &TimeLineView::interrupted, this, [this] { letGo(); });
}

double TimeLineWidget::toX_px(double time) const {
    const double room = std::max(1, width() - kNames_px - kRight_px);
    return kNames_px + (time - view_.first()) / (view_.last() - view_.first()) * room;
}

double TimeLineWidget::toTime(double x_px) const {
    const double room = std::max(1, width() - kNames_px - kRight_px);
    return view_.first() + (x_px - kNames_px) / room * (view_.last() - view_.first());
}

float TimeLineWidget::toFrameTime(double x_px) const {
    const double rate = static_cast<double>(view_.line().framesPerSecond);
    return static_cast<float>(std::max(0.0, std::round(toTime(x_px) * rate)) / rate);
}

QColor TimeLineWidget::playHeadColour() const {
    return view_.player().shown() == Player::Shown::posed ? colours().caution : colours().accent;
}

void TimeLineWidget::paintPlayHead(QPainter& painter) const {
    const double x = toX_px(static_cast<double>(view_.player().lineTime()));
    if (x < kNames_px - 1 || x > width()) return;
    painter.setPen(QPen(playHeadColour(), 2));
    painter.drawLine(QPointF(x, 0), QPointF(x, height()));
}

void TimeLineWidget::paintFocus(QPainter& painter) const {
    if (!hasFocus()) return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(colours().accent);
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

bool TimeLineWidget::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride && isTimeLineKey(*static_cast<QKeyEvent*>(event))) {
        event->accept();
        return true;
    }
    return QWidget::event(event);
}

bool TimeLineWidget::act(const QKeyEvent& event) {
    Player& player = view_.player();
    const auto modifiers = event.modifiers() & ~Qt::KeypadModifier;
    switch (event.key()) {
        case Qt::Key_Left:
        case Qt::Key_Right: {
            const int by = event.key() == Qt::Key_Right ? 1 : -1;
            if (modifiers == Qt::ControlModifier)
                view_.goToKey(by);
            else if (modifiers == Qt::AltModifier)
                view_.moveSelected(by);
            else
                player.scrubFrames(by);
            return true;
        }
        case Qt::Key_PageUp:
            player.scrubFrames(-kPage);
            return true;
        case Qt::Key_PageDown:
            player.scrubFrames(kPage);
            return true;
        case Qt::Key_Home:
            player.scrub(view_.line().start);
            return true;
        case Qt::Key_End:
            player.scrub(view_.line().end);
            return true;
        case Qt::Key_Up:
            view_.moveRow(-1);
            return true;
        case Qt::Key_Down:
            view_.moveRow(1);
            return true;
        case Qt::Key_Delete:
        case Qt::Key_Backspace:
            view_.removeSelected();
            return true;
        case Qt::Key_Return:
        case Qt::Key_Enter:
            Q_EMIT view_.editRequested();
            return true;
        case Qt::Key_Escape:
            letGo();
            view_.isDragging() ? view_.cancelDrag() : view_.select({});
            return true;
        case Qt::Key_D:
            if (modifiers != Qt::ControlModifier) return false;
            view_.copySelectedHere();
            return true;
        case Qt::Key_A:
            if (modifiers != Qt::ControlModifier) return false;
            view_.selectAll();
            return true;
        default:
            return false;
    }
}

void TimeLineWidget::keyPressEvent(QKeyEvent* event) {
    if (!act(*event)) QWidget::keyPressEvent(event);
}

void TimeLineWidget::wheelEvent(QWheelEvent* event) {
    const QPoint turned = event->angleDelta();
    const bool isShift = (event->modifiers() & Qt::ShiftModifier) != 0;
    // Alt and some window systems turn the wheel sideways.
    const double along = static_cast<double>(isShift && turned.x() == 0 ? turned.y() : turned.x());
    if (event->modifiers() & Qt::ControlModifier) {
        const double notches = static_cast<double>(turned.y()) / kNotch;
        view_.zoom(std::pow(kZoomPerNotch, notches), toTime(event->position().x()));
    } else if (along != 0) {
        view_.pan(-along / kNotch * kPanPerNotch * (view_.last() - view_.first()));
    } else {
        event->ignore();  // rows scroll
    }
}

void TimeLineWidget::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::MiddleButton) panFrom_px_ = event->position().x();
    if (event->button() == Qt::LeftButton) press(*event);
}

void TimeLineWidget::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons() & Qt::MiddleButton) {
        view_.pan(toTime(panFrom_px_) - toTime(event->position().x()));
        panFrom_px_ = event->position().x();
    } else if (event->buttons() & Qt::LeftButton) {
        dragged(*event);
    } else {
        hover(*event);
    }
}

void TimeLineWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) release(*event);
}

}  // namespace hairloom::editor
