// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/accuracy_plot.h"

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace hairloom::editor {
namespace {

constexpr double kReach_px = 10;      ///< of the pointer
constexpr double kRadius_px = 4;      ///< of a point
constexpr double kEdge_px = 14;       ///< above the plot, for diverged settings
constexpr double kLeastError = 1e-4;  ///< in the axis' unit; what is nearer is drawn there

/// Whole decades and their 2 and 5 that lie in a span.
std::vector<double> ticksOf(double low, double high) {
    std::vector<double> ticks;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10) {
        for (const double factor : {1, 2, 5}) {
            const double value = decade * factor;
            if (value >= low * 0.999 && value <= high * 1.001) ticks.push_back(value);
        }
    }
    return ticks;
}

QString short_(double value) {
    constexpr double kThousand = 1000;
    if (value < kThousand) return QString::number(value, 'g', 3);
    return QStringLiteral("%1 k").arg(value / kThousand, 0, 'g', 3);
}

QString inUnit(const QString& value, const QString& unit) {
    return unit.isEmpty() ? value : value + ' ' + unit;
}

QString axis(const QString& name, const QString& unit) {
    return unit.isEmpty() ? name : QStringLiteral("%1 [%2]").arg(name, unit);
}

}  // namespace

double AccuracyPlot::Span::shareOf(double value) const {
    return std::log(value / low) / std::log(high / low);
}

AccuracyPlot::AccuracyPlot(QWidget* parent) : QWidget(parent) {
    setMouseTracking(true);
    setObjectName("accuracyPlot");
}

void AccuracyPlot::setAxes(const QString& cost, const QString& costUnit, const QString& error) {
    cost_ = cost;
    costUnit_ = costUnit;
    errorName_ = error;
}

void AccuracyPlot::setPoints(std::vector<AccuracyPoint> points, const QString& unit) {
    points_ = std::move(points);
    unit_ = unit;
    const auto within = [this](std::optional<std::size_t> point) {
        return point && *point < points_.size() ? point : std::nullopt;
    };
    now_ = within(now_);
    chosen_ = within(chosen_);
    hovered_ = within(hovered_);
    findSpans();
    update();
}

void AccuracyPlot::setMarked(std::optional<std::size_t> now, std::optional<std::size_t> chosen) {
    now_ = now;
    chosen_ = chosen;
    update();
}

void AccuracyPlot::findSpans() {
    constexpr double kMargin = 1.25;
    bool first = true, firstError = true;
    for (const AccuracyPoint& point : points_) {
        if (!(point.milliseconds > 0)) continue;
        time_.low = first ? point.milliseconds : std::min(time_.low, point.milliseconds);
        time_.high = first ? point.milliseconds : std::max(time_.high, point.milliseconds);
        first = false;
        if (point.diverged) continue;
        const double error = std::max(point.error, kLeastError);
        error_.low = firstError ? error : std::min(error_.low, error);
        error_.high = firstError ? error : std::max(error_.high, error);
        firstError = false;
    }
    for (Span* span : {&time_, &error_}) {
        span->low /= kMargin;
        span->high *= kMargin;
    }
}

QRectF AccuracyPlot::plot_px() const {
    const int digits = fontMetrics().horizontalAdvance("0.005");
    return QRectF(rect()).adjusted(digits + 12, kEdge_px + fontMetrics().height(), -10,
                                   -2 * fontMetrics().height() - 6);
}

QPointF AccuracyPlot::place_px(std::size_t point) const {
    const QRectF plot = plot_px();
    const AccuracyPoint& shown = points_[point];
    const double x = plot.left() + plot.width() * time_.shareOf(std::max(shown.milliseconds, time_.low));
    if (shown.diverged) return {x, plot.top() - kEdge_px / 2};
    return {x, plot.bottom() - plot.height() * error_.shareOf(std::max(shown.error, kLeastError))};
}

std::optional<std::size_t> AccuracyPlot::pointAt(const QPointF& at) const {
    std::optional<std::size_t> nearest;
    double minimum = kReach_px;
    for (std::size_t p = 0; p < points_.size(); ++p) {
        const QPointF away = at - place_px(p);
        const double distance = std::hypot(away.x(), away.y());
        if (distance > minimum) continue;
        minimum = distance;
        nearest = p;
    }
    return nearest;
}

void AccuracyPlot::drawAxes(QPainter& painter) const {
    const QRectF plot = plot_px();
    painter.fillRect(plot, palette().color(QPalette::Base));
    const int line = fontMetrics().height();
    const QColor grid = palette().color(QPalette::Mid), text = palette().color(QPalette::PlaceholderText);
    double free = -1;
    for (const double tick : ticksOf(time_.low, time_.high)) {
        const double x = plot.left() + plot.width() * time_.shareOf(tick);
        painter.setPen(grid);
        painter.drawLine(QPointF(x, plot.top()), QPointF(x, plot.bottom()));
        const double wide = fontMetrics().horizontalAdvance(short_(tick));
        if (x - wide / 2 < free) continue;
        free = x + wide / 2 + 6;
        painter.setPen(text);
        painter.drawText(QRectF(x - 30, plot.bottom() + 2, 60, line), Qt::AlignHCenter, short_(tick));
    }
    free = height();
    for (const double tick : ticksOf(error_.low, error_.high)) {
        const double y = plot.bottom() - plot.height() * error_.shareOf(tick);
        painter.setPen(grid);
        painter.drawLine(QPointF(plot.left(), y), QPointF(plot.right(), y));
        if (y + line / 2.0 > free) continue;
        free = y - line / 2.0;
        painter.setPen(text);
        painter.drawText(QRectF(0, y - line / 2.0, plot.left() - 6, line), Qt::AlignRight | Qt::AlignVCenter,
                         short_(tick));
    }
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(QRectF(0, 0, width(), line), Qt::AlignLeft, axis(errorName_, unit_));
    painter.drawText(QRectF(0, height() - line, width() - 10, line), Qt::AlignRight, axis(cost_, costUnit_));
}

QColor AccuracyPlot::colourOf(const AccuracyPoint& point) const {
    if (point.onFront) return palette().color(QPalette::Highlight);
    return palette().color(lines_ ? QPalette::PlaceholderText : QPalette::Mid);
}

void AccuracyPlot::drawLine(QPainter& painter, std::vector<std::size_t> points) const {
    std::ranges::sort(points, {}, [this](std::size_t p) { return points_[p].milliseconds; });
    QPainterPath path;
    for (const std::size_t p : points)
        p == points.front() ? path.moveTo(place_px(p)) : path.lineTo(place_px(p));
    painter.setBrush(Qt::NoBrush);
    painter.setPen(colourOf(points_[points.front()]));
    painter.drawPath(path);
}

void AccuracyPlot::drawPoint(QPainter& painter, std::size_t p) const {
    const AccuracyPoint& point = points_[p];
    const QPointF at = place_px(p);
    const QRectF plot = plot_px();
    const QColor colour = colourOf(point);
    painter.setPen(colour);
    if (point.q3 > point.q1 && point.q1 > 0) {
        const auto across = [&](double ms) {
            return plot.left() + plot.width() * std::clamp(time_.shareOf(ms), 0.0, 1.0);
        };
        painter.drawLine(QPointF(across(point.q1), at.y()), QPointF(across(point.q3), at.y()));
    }
    if (point.diverged) {
        painter.drawLine(at + QPointF(-3, 3), at + QPointF(0, -3));
        painter.drawLine(at + QPointF(3, 3), at + QPointF(0, -3));
        return;
    }
    painter.setBrush(colour);
    painter.drawEllipse(at, kRadius_px, kRadius_px);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(palette().color(QPalette::Text), 1.5));
    if (now_ == p) painter.drawEllipse(at, kRadius_px + 3, kRadius_px + 3);
    if (chosen_ == p) painter.drawRect(QRectF(at.x() - 8, at.y() - 8, 16, 16));
}

void AccuracyPlot::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    drawAxes(painter);
    std::map<std::pair<bool, std::size_t>, std::vector<std::size_t>> lines;  // what stands out comes last
    for (std::size_t p = 0; p < points_.size(); ++p) {
        const AccuracyPoint& point = points_[p];
        if (!point.diverged && (lines_ || point.onFront)) lines[{point.onFront, point.line}].push_back(p);
    }
    for (const auto& [line, points] : lines) drawLine(painter, points);
    for (std::size_t p = 0; p < points_.size(); ++p) drawPoint(painter, p);
}

void AccuracyPlot::mouseMoveEvent(QMouseEvent* event) {
    hovered_ = pointAt(event->position());
    if (!hovered_) return QToolTip::hideText();
    const AccuracyPoint& point = points_[*hovered_];
    const QString error = point.diverged ? QString("diverges") : inUnit(short_(point.error), unit_);
    QToolTip::showText(
        event->globalPosition().toPoint(),
        QString("%1: %2, %3").arg(point.words, inUnit(short_(point.milliseconds), costUnit_), error), this);
}

void AccuracyPlot::mousePressEvent(QMouseEvent* event) {
    const auto point = pointAt(event->position());
    if (point && !points_[*point].diverged) Q_EMIT clicked(*point);
}

void AccuracyPlot::leaveEvent(QEvent*) {
    hovered_.reset();
}

}  // namespace hairloom::editor
