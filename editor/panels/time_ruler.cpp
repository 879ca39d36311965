// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/time_ruler.h"

#include <cmath>

namespace hairloom::editor {
namespace {

constexpr int kPlayed_px = 3;     ///< of the bar of what has played
constexpr double kApart_px = 56;  ///< between two numbers
constexpr int kTick_px = 16;      ///< where numbers end and their ticks begin

/// 1, 2 or 5 times a power of ten, at least `least`.
double roundStep(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(std::max(least, 1.0))));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10 * power;
}

}  // namespace

TimeRuler::TimeRuler(TimeLineView& view, QWidget* parent)
    : TimeLineWidget(view, "timeRuler", "Play head", parent) {
    setFixedHeight(kHeight_px);
    setToolTip(
        "Drag to any frame. Arrow keys step one frame, Page up and Page down ten, Home and End go to the "
        "range. The bar below the numbers marks frames that have played: they are shown as they played. "
        "Ctrl and the wheel zoom, Shift and the wheel or the middle button pan");
}

void TimeRuler::press(QMouseEvent& event) {
    if (event.position().x() > kNames_px - 8) view().player().scrub(toFrameTime(event.position().x()));
}

void TimeRuler::dragged(QMouseEvent& event) {
    view().player().scrub(toFrameTime(event.position().x()));
}

void TimeRuler::paintFrames(QPainter& painter) const {
    const double rate = static_cast<double>(view().line().framesPerSecond);
    const double first = toTime(kNames_px) * rate, last = toTime(width()) * rate;
    const double perPixel = (last - first) / std::max(1, width() - kNames_px);
    const double step = roundStep(kApart_px * perPixel);
    painter.setPen(colours().dimText);
    for (double frame = std::ceil(first / step) * step; frame <= last; frame += step) {
        const double x = toX_px(frame / rate);
        const QString number = QString::number(std::llround(frame));
        if (x + fontMetrics().horizontalAdvance(number) / 2.0 > width()) break;
        painter.drawLine(QPointF(x, kTick_px), QPointF(x, kTick_px + 6));
        painter.drawText(QRectF(x - 40, 1, 80, kTick_px - 1), Qt::AlignCenter, number);
    }
}

void TimeRuler::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const TimeLine& line = view().line();
    const double rate = static_cast<double>(line.framesPerSecond);
    const double start = static_cast<double>(line.start), end = static_cast<double>(line.end);
    painter.setClipRect(keysArea());
    painter.fillRect(QRectF(QPointF(toX_px(start), 0), QPointF(toX_px(end), height())), colours().field);
    if (line.preRoll > 0) {
        const QRectF before(QPointF(toX_px(start - static_cast<double>(line.preRoll) / rate), 0),
                            QPointF(toX_px(start), height()));
        painter.fillRect(before, QBrush(palette().color(QPalette::Mid), Qt::BDiagPattern));
    }
    const FrameCache& cache = view().player().frameCache();
    const double cached = static_cast<double>(cache.framesPerSecond());
    for (const auto& [from, to] : cache.runs()) {
        const double left = toX_px((static_cast<double>(from) - 0.5) / cached);
        const double right = toX_px((static_cast<double>(to) + 0.5) / cached);
        painter.fillRect(QRectF(left, height() - 8, right - left, kPlayed_px), colours().accent);
    }
    paintFrames(painter);
    // Below the numbers.
    painter.setClipRect(keysArea().adjusted(0, kTick_px, 0, 0));
    paintPlayHead(painter);
    const double at = toX_px(static_cast<double>(view().player().lineTime()));
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(playHeadColour());
    painter.setPen(Qt::NoPen);
    painter.drawPolygon(QPolygonF({{at - 6, 16}, {at + 6, 16}, {at + 6, 20}, {at, 27}, {at - 6, 20}}));
    painter.setClipping(false);
    painter.setPen(colours().dimText);
    painter.drawText(QRect(8, 0, kNames_px - 34, height()), Qt::AlignVCenter, "Frame");
    paintFocus(painter);
}

}  // namespace hairloom::editor
