// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/ramp_edit.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hairloom::editor {
namespace {

using runtime::Ramp;

constexpr double kReach_px = 9;     ///< of the pointer
constexpr float kMinApart = 0.01f;  ///< two keys along the curve
constexpr float kStep = 0.01f;      ///< of a press of an arrow key

}  // namespace

RampEdit::RampEdit(QWidget* parent) : QWidget(parent) {
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
}

void RampEdit::setRamp(const Ramp& ramp) {
    if (ramp.count != ramp_.count) {
        held_ = false;
        chosen_ = std::min(chosen_, ramp.count - 1);
    }
    ramp_ = ramp;
    update();
}

QRectF RampEdit::plot_px() const {
    return QRectF(rect()).adjusted(34, 8, -10, -22);
}

QPointF RampEdit::toPlot_px(float at, float value) const {
    const QRectF plot = plot_px();
    return {plot.left() + plot.width() * static_cast<double>(at),
            plot.bottom() - plot.height() * static_cast<double>(value)};
}

float RampEdit::along(const QPointF& place_px) const {
    const QRectF plot = plot_px();
    return static_cast<float>((place_px.x() - plot.left()) / plot.width());
}

QPointF RampEdit::handle_px(std::uint32_t key) const {
    return toPlot_px(ramp_.keys[key].at, ramp_.keys[key].value);
}

std::optional<std::uint32_t> RampEdit::keyAt(const QPointF& place_px) const {
    std::optional<std::uint32_t> nearest;
    double minimum = kReach_px;
    for (std::uint32_t k = 0; k < ramp_.count; ++k) {
        const QPointF offset = place_px - handle_px(k);
        const double distance = std::hypot(offset.x(), offset.y());
        if (distance > minimum) continue;
        minimum = distance;
        nearest = k;
    }
    return nearest;
}

bool RampEdit::mayAddAt(const QPointF& place_px) const {
    const float at = along(place_px);
    if (ramp_.count == Ramp::kMaxKeys || !(at > 0 && at < 1)) return false;
    if (std::abs(place_px.y() - toPlot_px(at, ramp_.at(at)).y()) > kReach_px) return false;
    return std::ranges::none_of(ramp_.inUse(),
                                [&](const Ramp::Key& key) { return std::abs(key.at - at) < kMinApart; });
}

void RampEdit::addKey(const QPointF& place_px) {
    const float at = along(place_px);
    std::vector<Ramp::Key> keys(ramp_.inUse().begin(), ramp_.inUse().end());
    const auto behind = std::ranges::find_if(keys, [&](const Ramp::Key& key) { return key.at > at; });
    chosen_ = static_cast<std::uint32_t>(behind - keys.begin());
    keys.insert(behind, {at, ramp_.at(at)});
    ramp_ = Ramp::of(keys);
    Q_EMIT edited(ramp_);
}

void RampEdit::removeKey(std::uint32_t key) {
    if (key == 0 || key + 1 >= ramp_.count) return;
    std::vector<Ramp::Key> keys(ramp_.inUse().begin(), ramp_.inUse().end());
    keys.erase(keys.begin() + key);
    chosen_ = key - 1;
    ramp_ = Ramp::of(keys);
    Q_EMIT begun();
    Q_EMIT edited(ramp_);
    update();
}

void RampEdit::moveKey(std::uint32_t key, float at, float value) {
    Ramp::Key moved{ramp_.keys[key].at, std::clamp(value, 0.0f, 1.0f)};
    if (key > 0 && key + 1 < ramp_.count) {
        const float first = ramp_.keys[key - 1].at + kMinApart, last = ramp_.keys[key + 1].at - kMinApart;
        if (first <= last) moved.at = std::clamp(at, first, last);
    }
    if (moved == ramp_.keys[key]) return;
    ramp_.keys[key] = moved;
    Q_EMIT edited(ramp_);
    update();
}

void RampEdit::drawGrid(QPainter& painter) const {
    const QRectF plot = plot_px();
    painter.fillRect(plot, palette().color(QPalette::Base));
    for (const double level : {0.0, 0.5, 1.0}) {
        const double y = plot.bottom() - level * plot.height();
        painter.setPen(palette().color(QPalette::Mid));
        painter.drawLine(QPointF(plot.left(), y), QPointF(plot.right(), y));
        painter.setPen(palette().color(QPalette::PlaceholderText));
        painter.drawText(QRectF(0, y - 8, plot.left() - 7, 16), Qt::AlignRight | Qt::AlignVCenter,
                         QString::number(level, 'g', 2));
    }
    const QRectF below(plot.left(), plot.bottom() + 4, plot.width(), 18);
    painter.drawText(below, Qt::AlignLeft, "Root");
    painter.drawText(below, Qt::AlignRight, "Tip");
}

void RampEdit::drawCurve(QPainter& painter) const {
    QPolygonF line;
    for (std::uint32_t k = 0; k < ramp_.count; ++k) line << handle_px(k);
    const QColor colour = palette().color(QPalette::Highlight);
    QColor fill = colour;
    fill.setAlpha(60);
    painter.setPen(Qt::NoPen);
    painter.setBrush(fill);
    painter.drawPolygon(QPolygonF(line) << plot_px().bottomRight() << plot_px().bottomLeft());
    painter.setPen(QPen(colour, 2));
    painter.drawPolyline(line);
    painter.setPen(QPen(colour, 1.5));
    for (std::uint32_t k = 0; k < ramp_.count; ++k) {
        const bool isChosen = hasFocus() && k == chosen_;
        painter.setBrush(palette().color(QPalette::Text));
        painter.drawEllipse(line[static_cast<qsizetype>(k)], isChosen ? 6.5 : 5, isChosen ? 6.5 : 5);
    }
}

void RampEdit::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    drawGrid(painter);
    drawCurve(painter);
}

void RampEdit::mousePressEvent(QMouseEvent* event) {
    const auto key = keyAt(event->position());
    if (event->button() == Qt::RightButton && key) return removeKey(*key);
    if (event->button() != Qt::LeftButton || (!key && !mayAddAt(event->position()))) return;
    held_ = true;
    Q_EMIT begun();
    if (key) {
        chosen_ = *key;
        update();
    } else {
        addKey(event->position());
    }
}

void RampEdit::mouseMoveEvent(QMouseEvent* event) {
    const QPointF place = event->position();
    if (!held_) {
        setCursor(keyAt(place) ? Qt::SizeAllCursor : mayAddAt(place) ? Qt::CrossCursor : Qt::ArrowCursor);
        return;
    }
    const QRectF plot = plot_px();
    moveKey(chosen_, along(place), static_cast<float>((plot.bottom() - place.y()) / plot.height()));
}

void RampEdit::mouseReleaseEvent(QMouseEvent*) {
    held_ = false;
}

bool RampEdit::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride &&
        static_cast<QKeyEvent*>(event)->key() == Qt::Key_Delete) {
        event->accept();
        return true;
    }
    return QWidget::event(event);
}

void RampEdit::keyPressEvent(QKeyEvent* event) {
    const auto [at, value] = ramp_.keys[chosen_];
    const auto moveBy = [&](float forth, float up) {
        Q_EMIT begun();
        moveKey(chosen_, at + forth, value + up);
    };
    switch (event->key()) {
        case Qt::Key_Up:
            return moveBy(0, kStep);
        case Qt::Key_Down:
            return moveBy(0, -kStep);
        case Qt::Key_Left:
            return moveBy(-kStep, 0);
        case Qt::Key_Right:
            return moveBy(kStep, 0);
        case Qt::Key_PageUp:
            chosen_ = chosen_ == 0 ? 0 : chosen_ - 1;
            return update();
        case Qt::Key_PageDown:
            chosen_ = std::min(chosen_ + 1, ramp_.count - 1);
            return update();
        case Qt::Key_Delete:
        case Qt::Key_Backspace:
            return removeKey(chosen_);
        default:
            QWidget::keyPressEvent(event);
    }
}

}  // namespace hairloom::editor
