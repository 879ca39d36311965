// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/time_ruler.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr int kPlayed_px = 3;       ///< of the bar of what has played
constexpr double kApart_px = 56;    ///< between two numbers
constexpr std::int64_t kPage = 10;  ///< frames
constexpr double kZoomPerNotch = 0.8;

/// 1, 2 or 5 times a power of ten, at least `least`.
double roundStep(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(std::max(least, 1.0))));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10 * power;
}

}  // namespace

TimeRuler::TimeRuler(TimeLineView& view, QWidget* parent) : QWidget(parent), view_(view) {
    setObjectName("timeRuler");
    setFixedHeight(kHeight_px);
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName("Play head");
    setToolTip(
        "Drag to any frame. Arrow keys step one frame, Page up and Page down ten, Home and End go to the "
        "range. The bar below the numbers marks frames that have played: they are shown as they played. "
        "Ctrl and the wheel zoom");
    connect(&view_, &TimeLineView::changed, this, qOverload<>(&QWidget::update));
}

void TimeRuler::scrubTo(double x_px) {
    view_.player().scrub(view_.toFrameTime(x_px, width()));
}

void TimeRuler::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton && event->position().x() > TimeLineView::kNames_px - 8)
        scrubTo(event->position().x());
}

void TimeRuler::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons() & Qt::LeftButton) scrubTo(event->position().x());
}

void TimeRuler::wheelEvent(QWheelEvent* event) {
    if (!(event->modifiers() & Qt::ControlModifier)) return event->ignore();
    const double about = view_.toTime(event->position().x(), width());
    view_.zoom(event->angleDelta().y() > 0 ? kZoomPerNotch : 1 / kZoomPerNotch, about);
}

void TimeRuler::keyPressEvent(QKeyEvent* event) {
    if (!stepByKey(view_, *event)) QWidget::keyPressEvent(event);
}

bool TimeRuler::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride && isTimeLineKey(*static_cast<QKeyEvent*>(event))) {
        event->accept();
        return true;
    }
    return QWidget::event(event);
}

void TimeRuler::paintFrames(QPainter& painter) const {
    const TimeLine& line = view_.line();
    const double rate = static_cast<double>(line.framesPerSecond);
    const double first = view_.toTime(TimeLineView::kNames_px, width()) * rate;
    const double last = view_.toTime(width(), width()) * rate;
    const double perPixel = (last - first) / std::max(1, width() - TimeLineView::kNames_px);
    const double step = roundStep(kApart_px * perPixel);
    painter.setPen(palette().color(QPalette::PlaceholderText));
    for (double frame = std::ceil(first / step) * step; frame <= last; frame += step) {
        const double x = view_.toX_px(frame / rate, width());
        painter.drawLine(QPointF(x, 16), QPointF(x, 22));
        painter.drawText(QRectF(x - 40, 1, 80, 15), Qt::AlignCenter, QString::number(std::llround(frame)));
    }
}

void TimeRuler::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const TimeLine& line = view_.line();
    const double rate = static_cast<double>(line.framesPerSecond);
    const auto x = [&](double time) { return view_.toX_px(time, width()); };
    const double start = static_cast<double>(line.start), end = static_cast<double>(line.end);
    painter.setClipRect(QRect(TimeLineView::kNames_px - 24, 0, width(), height()));
    const QRectF range(QPointF(x(start), 0), QPointF(x(end), height()));
    painter.fillRect(range, palette().color(QPalette::Base));
    if (line.preRoll > 0) {
        const QRectF before(QPointF(x(start - static_cast<double>(line.preRoll) / rate), 0),
                            QPointF(x(start), height()));
        painter.fillRect(before, QBrush(palette().color(QPalette::Mid), Qt::BDiagPattern));
    }
    for (const auto& [from, to] : view_.player().playedFrames().runs()) {
        const double left = x((static_cast<double>(from) - 0.5) / rate);
        const double right = x((static_cast<double>(to) + 0.5) / rate);
        painter.fillRect(QRectF(left, height() - 8, right - left, kPlayed_px),
                         palette().color(QPalette::Highlight));
    }
    paintFrames(painter);
    view_.paintPlayHead(painter, rect());
    const double at = x(static_cast<double>(view_.player().lineTime()));
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(0x4c, 0x8d, 0xff));
    painter.drawPolygon(QPolygonF({{at - 6, 14}, {at + 6, 14}, {at + 6, 18}, {at, 25}, {at - 6, 18}}));
    painter.setClipping(false);
    painter.setPen(palette().color(QPalette::PlaceholderText));
    painter.drawText(QRect(8, 0, TimeLineView::kNames_px - 34, height()), Qt::AlignVCenter, "Frames");
    if (!hasFocus()) return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(palette().color(QPalette::Highlight));
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
}

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

bool stepByKey(TimeLineView& view, const QKeyEvent& key) {
    Player& player = view.player();
    switch (key.key()) {
        case Qt::Key_Left:
            player.scrubFrames(-1);
            return true;
        case Qt::Key_Right:
            player.scrubFrames(1);
            return true;
        case Qt::Key_PageUp:
            player.scrubFrames(-kPage);
            return true;
        case Qt::Key_PageDown:
            player.scrubFrames(kPage);
            return true;
        case Qt::Key_Home:
            player.scrub(view.line().start);
            return true;
        case Qt::Key_End:
            player.scrub(view.line().end);
            return true;
        default:
            return false;
    }
}

}  // namespace hairloom::editor
