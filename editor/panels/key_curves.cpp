// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/key_curves.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "editor/fields/number_spin.h"
#include "editor/panels/time_ruler.h"

namespace hairloom::editor {
namespace {

constexpr double kReach_px = 8, kPoint_px = 4, kMargin_px = 12;

/// Of X, Y and Z, and of a number alone.
QColor colourOf(std::size_t number, std::size_t count) {
    static const QColor colours[] = {QColor(0xe0, 0x5a, 0x5a), QColor(0x6a, 0xbf, 0x5b),
                                     QColor(0x5b, 0x8f, 0xe8)};
    return count < 3 || number > 2 ? QColor(0xf2, 0xb1, 0x34) : colours[number];
}

}  // namespace

KeyCurves::KeyCurves(TimeLineView& view, QWidget* parent) : QWidget(parent), view_(view) {
    setObjectName("keyCurves");
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName("Curves of the selected row");
    setToolTip(
        "Drag a key up or down to change its value, sideways to move it in time. Shift keeps its time. X is "
        "red, Y is green, Z is blue. Double-click a key to type its value. Left and right step frames");
    connect(&view_, &TimeLineView::changed, this, qOverload<>(&QWidget::update));
}

KeyCurves::Range KeyCurves::rangeOf(const std::string& unit) const {
    Range range{0, 0};
    bool isFirst = true;
    const auto track = view_.current();
    if (!track) return {0, 1};
    const std::vector<KeyNumber> numbers = numbersOf(*track);
    const std::size_t count = keyTimes(view_.line(), *track).size();
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (!numbers[n].isDrawn || numbers[n].unit != unit) continue;
        for (std::size_t k = 0; k < count; ++k) {
            const double value = numberOf(view_.line(), {*track, k}, n);
            range.low = isFirst ? value : std::min(range.low, value);
            range.high = isFirst ? value : std::max(range.high, value);
            isFirst = false;
        }
    }
    const double room = std::max(0.1 * (range.high - range.low), 0.05 * std::max(std::abs(range.high), 0.02));
    return {range.low - room, range.high + room};
}

double KeyCurves::toY_px(double value, const Range& range) const {
    const double share = (value - range.low) / (range.high - range.low);
    return height() - kMargin_px - share * (height() - 2 * kMargin_px);
}

QPointF KeyCurves::placeOf(const KeyPlace& key, std::size_t number) const {
    const KeyNumber info = numbersOf(key.track)[number];
    const double time = static_cast<double>(keyTimes(view_.line(), key.track)[key.index]);
    const Range range = held_ ? heldRange_ : rangeOf(info.unit);
    return {view_.toX_px(time, width()), toY_px(numberOf(view_.line(), key, number), range)};
}

std::optional<KeyCurves::Point> KeyCurves::pointAt(const QPointF& place) const {
    const auto track = view_.current();
    if (!track) return std::nullopt;
    const std::vector<KeyNumber> numbers = numbersOf(*track);
    const std::size_t count = keyTimes(view_.line(), *track).size();
    std::optional<Point> found;
    double least = kReach_px;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        for (std::size_t k = 0; numbers[n].isDrawn && k < count; ++k) {
            const QPointF by = placeOf({*track, k}, n) - place;
            const double distance = std::hypot(by.x(), by.y());
            if (distance > least) continue;
            least = distance;
            found = Point{{*track, k}, n};
        }
    }
    return found;
}

void KeyCurves::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    from_ = event->position();
    const auto point = pointAt(from_);
    if (!point) return view_.select({});
    heldRange_ = rangeOf(numbersOf(point->key.track)[point->number].unit);
    view_.select({point->key});
    held_ = point;
}

void KeyCurves::mouseMoveEvent(QMouseEvent* event) {
    if (!held_ || !(event->buttons() & Qt::LeftButton)) return;
    const TimeLine& before = view_.keying().line();
    const KeyNumber info = numbersOf(held_->key.track)[held_->number];
    const double perPixel = (heldRange_.high - heldRange_.low) / (height() - 2 * kMargin_px);
    double value =
        numberOf(before, held_->key, held_->number) - (event->position().y() - from_.y()) * perPixel;
    value = std::clamp(value, info.min, info.max);
    if (info.isWhole) value = std::round(value);
    TimeLine to = before;
    setNumber(to, held_->key, held_->number, value);
    std::vector<KeyPlace> moved{held_->key};
    if (!(event->modifiers() & Qt::ShiftModifier)) {
        const double by = view_.toTime(event->position().x(), width()) - view_.toTime(from_.x(), width());
        moved = moveKeys(to, moved, view_.frameOf(by));
    }
    view_.drag(std::move(to), std::move(moved));
}

void KeyCurves::mouseReleaseEvent(QMouseEvent*) {
    held_.reset();
    view_.drop("Edit key");
    update();
}

void KeyCurves::mouseDoubleClickEvent(QMouseEvent* event) {
    if (!pointAt(event->position())) return;
    view_.select({pointAt(event->position())->key});
    Q_EMIT view_.editRequested();
}

void KeyCurves::wheelEvent(QWheelEvent* event) {
    if (!(event->modifiers() & Qt::ControlModifier)) return event->ignore();
    view_.zoom(event->angleDelta().y() > 0 ? 0.8 : 1.25, view_.toTime(event->position().x(), width()));
}

bool KeyCurves::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride && isTimeLineKey(*static_cast<QKeyEvent*>(event))) {
        event->accept();
        return true;
    }
    return QWidget::event(event);
}

void KeyCurves::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape) {
        held_.reset();
        return view_.cancelDrag();
    }
    if (event->key() == Qt::Key_Delete || event->key() == Qt::Key_Backspace) return view_.removeSelected();
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
        Q_EMIT view_.editRequested();
        return;
    }
    if (!stepByKey(view_, *event)) QWidget::keyPressEvent(event);
}

/// As it plays: a line from key to key, a step, or slow at both ends.
void KeyCurves::paintCurve(QPainter& painter, const KeyTrack& track, std::size_t number,
                           const KeyNumber& info, const QColor& colour) const {
    constexpr int kPieces = 12;
    const TimeLine& line = view_.line();
    const std::vector<float> times = keyTimes(line, track);
    const Range range = held_ ? heldRange_ : rangeOf(info.unit);
    const auto valueOf = [&](std::size_t k) { return numberOf(line, {track, k}, number); };
    QPolygonF curve;
    curve << QPointF(TimeLineView::kNames_px, toY_px(valueOf(0), range));
    for (std::size_t k = 0; k < times.size(); ++k) {
        curve << placeOf({track, k}, number);
        if (k + 1 == times.size()) break;
        const KeyInterpolation between = interpolationOf(line, {track, k});
        const QPointF next = placeOf({track, k + 1}, number);
        if (between == KeyInterpolation::step) curve << QPointF(next.x(), curve.back().y());
        if (between != KeyInterpolation::smooth) continue;
        const QPointF here = curve.back();
        for (int piece = 1; piece < kPieces; ++piece) {
            const double share = static_cast<double>(piece) / kPieces;
            const double eased = share * share * (3 - 2 * share);
            curve << QPointF(here.x() + share * (next.x() - here.x()),
                             here.y() + eased * (next.y() - here.y()));
        }
    }
    curve << QPointF(width(), curve.back().y());
    painter.setPen(QPen(colour, 1.5));
    painter.setBrush(Qt::NoBrush);
    painter.drawPolyline(curve);
    for (std::size_t k = 0; k < times.size(); ++k) {
        const bool chosen = view_.isSelected({track, k});
        painter.setBrush(chosen ? palette().color(QPalette::Text) : colour);
        painter.drawEllipse(placeOf({track, k}, number), kPoint_px, kPoint_px);
    }
}

void KeyCurves::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRect plot = rect().adjusted(TimeLineView::kNames_px, 0, 0, 0);
    painter.fillRect(plot, palette().color(QPalette::Base));
    const auto track = view_.current();
    const std::vector<KeyNumber> numbers = track ? numbersOf(*track) : std::vector<KeyNumber>();
    painter.setPen(palette().color(QPalette::Text));
    const QRect names = rect().adjusted(8, 4, TimeLineView::kNames_px - 8 - width(), -4);
    painter.drawText(names, Qt::AlignTop | Qt::TextWordWrap, track ? labelOf(*track) : QString());
    if (!numbers.empty()) {
        const Range range = rangeOf(numbers[0].unit);
        const auto say = [&](double value, Qt::Alignment where) {
            painter.drawText(rect().adjusted(0, 2, TimeLineView::kNames_px - 6 - width(), -2),
                             where | Qt::AlignRight,
                             QString("%1 %2").arg(numberLocale().toString(value, 'g', 3),
                                                  QString::fromUtf8(numbers[0].unit)));
        };
        painter.setPen(palette().color(QPalette::PlaceholderText));
        say(range.low, Qt::AlignBottom);
    } else {
        painter.setPen(palette().color(QPalette::PlaceholderText));
        painter.drawText(plot, Qt::AlignCenter, "Clips have no curve. Choose another row");
    }
    painter.setClipRect(plot);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (numbers[n].isDrawn) paintCurve(painter, *track, n, numbers[n], colourOf(n, numbers.size()));
    }
    view_.paintPlayHead(painter, rect());
    painter.setClipping(false);
    if (!hasFocus()) return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(palette().color(QPalette::Highlight));
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

}  // namespace hairloom::editor
