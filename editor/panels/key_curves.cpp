// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/key_curves.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "editor/fields/field.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {
namespace {

constexpr double kCurveReach_px = 8, kPoint_px = 4, kCurveMargin_px = 12;

/// The coarsest step of 1, 0.1, 0.01 … that a pixel is not finer than.
double roundTo(double value, double perPixel) {
    const double step = std::pow(10.0, std::floor(std::log10(std::max(perPixel, 1e-9))));
    return std::round(value / step) * step;
}

}  // namespace

KeyCurves::KeyCurves(TimeLineView& view, QWidget* parent)
    : TimeLineWidget(view, "keyCurves", "Curves of the selected row", parent) {
    setToolTip(
        "Drag a key up or down to change its value, sideways to move it in time. Shift keeps its time. "
        "Double-click a key to type its value, or a free place to add one. Up and down choose another row");
}

KeyCurves::Range KeyCurves::rangeOf(const KeyTrack& track, std::string_view unit) const {
    const std::vector<KeyNumber> numbers = numbersOf(track);
    if (held_ && held_->number < numbers.size() && numbers[held_->number].unit == unit) return heldRange_;
    Range range{0, 0};
    bool isFirst = true;
    const std::size_t count = keyTimes(view().line(), track).size();
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (!numbers[n].isDrawn || numbers[n].unit != unit) continue;
        for (std::size_t k = 0; k < count; ++k) {
            const double value = numberOf(view().line(), {track, k}, n);
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
    return height() - kCurveMargin_px - share * (height() - 2 * kCurveMargin_px);
}

QPointF KeyCurves::placeOf(const KeyPlace& key, std::size_t number) const {
    const KeyNumber info = numbersOf(key.track)[number];
    return {toX_px(static_cast<double>(keyTime(view().line(), key))),
            toY_px(numberOf(view().line(), key, number), rangeOf(key.track, info.unit))};
}

std::vector<KeyCurves::Curve> KeyCurves::curves() const {
    const auto track = view().current();
    if (!track) return {};
    const ThemeColours tones = colours();
    const std::vector<KeyNumber> numbers = numbersOf(*track);
    const std::vector<float> times = keyTimes(view().line(), *track);
    // As everywhere X is red, Y is green and Z is blue.
    const QColor axes[] = {tones.bad, tones.good, tones.accent};
    std::vector<Curve> curves;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (!numbers[n].isDrawn) continue;
        const bool isAxis = n < 3 && numbers.size() >= 3;
        Curve curve{n, numbers[n], rangeOf(*track, numbers[n].unit), isAxis ? axes[n] : tones.text, {}};
        for (std::size_t k = 0; k < times.size(); ++k)
            curve.points.emplace_back(toX_px(static_cast<double>(times[k])),
                                      toY_px(numberOf(view().line(), {*track, k}, n), curve.range));
        curves.push_back(std::move(curve));
    }
    return curves;
}

std::optional<KeyCurves::Point> KeyCurves::pointAt(const QPointF& place) const {
    const auto track = view().current();
    std::optional<Point> found;
    double least = kCurveReach_px;
    for (const Curve& curve : curves()) {
        for (std::size_t k = 0; k < curve.points.size(); ++k) {
            const QPointF by = curve.points[k] - place;
            const double distance = std::hypot(by.x(), by.y());
            if (distance > least) continue;
            least = distance;
            found = Point{{*track, k}, curve.number};
        }
    }
    return found;
}

void KeyCurves::press(QMouseEvent& event) {
    from_ = event.position();
    const auto point = pointAt(from_);
    if (!point) return view().select({});
    heldRange_ = rangeOf(point->key.track, numbersOf(point->key.track)[point->number].unit);
    view().select({point->key});
    held_ = point;
}

void KeyCurves::hover(QMouseEvent& event) {
    setCursor(pointAt(event.position()) ? Qt::PointingHandCursor : Qt::ArrowCursor);
}

void KeyCurves::dragged(QMouseEvent& event) {
    const QPointF by = event.position() - from_;
    if (!held_ || (!view().isDragging() && by.manhattanLength() < kDragFrom_px)) return;
    const TimeLine& before = view().keying().line();
    const KeyNumber info = numbersOf(held_->key.track)[held_->number];
    const double perPixel = (heldRange_.high - heldRange_.low) / (height() - 2 * kCurveMargin_px);
    const double was = numberOf(before, held_->key, held_->number);
    TimeLine to = before;
    if (std::abs(by.y()) >= 1) {
        double value = roundTo(was - by.y() * perPixel, perPixel);
        if (info.isWhole) value = std::round(value);
        setNumber(to, held_->key, held_->number, std::clamp(value, info.min, info.max));
    }
    std::vector<KeyPlace> moved{held_->key};
    if (!(event.modifiers() & Qt::ShiftModifier))
        moved = moveKeys(to, moved, view().frameOf(toTime(event.position().x()) - toTime(from_.x())));
    view().drag(std::move(to), std::move(moved));
}

void KeyCurves::release(QMouseEvent&) {
    view().drop("Edit key");
    letGo();
}

void KeyCurves::letGo() {
    held_.reset();
    update();
}

void KeyCurves::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    if (const auto point = pointAt(event->position())) {
        view().select({point->key});
        Q_EMIT view().editRequested();
    } else if (const auto track = view().current(); track && event->position().x() >= kNames_px) {
        view().insertKey(*track, toFrameTime(event->position().x()));
    }
}

/// The row, and of each colour what it is and which values its keys have.
void KeyCurves::paintNames(QPainter& painter, const std::vector<Curve>& curves) const {
    const auto track = view().current();
    const int line = fontMetrics().height();
    const int room = kNames_px - 16;
    int top = 2;
    const auto say = [&](const QString& text, const QColor& colour) {
        if (top + line > height()) return;
        painter.setPen(colour);
        painter.drawText(QRect(8, top, room, line), Qt::AlignVCenter,
                         fontMetrics().elidedText(text, Qt::ElideRight, room));
        top += line;
    };
    say(track ? labelOf(*track) : QString(), colours().text);
    for (const Curve& curve : curves) {
        const KeyNumber& info = curve.info;
        const Shown shown = shownAs(QString::fromUtf8(info.unit), info.min, info.max, view().lengths());
        const auto number = [&](std::size_t k) {
            return numberOf(view().line(), {*track, k}, curve.number) * shown.factor;
        };
        double low = number(0), high = low;
        for (std::size_t k = 1; k < curve.points.size(); ++k) {
            low = std::min(low, number(k));
            high = std::max(high, number(k));
        }
        QString span = numberLocale().toString(low, 'g', 3);
        if (low != high) span += QString("…%1").arg(numberLocale().toString(high, 'g', 3));
        say(QString("%1  %2 %3").arg(info.label, span, shown.unit), curve.colour);
    }
}

/// As it plays: a line from key to key, a step, or slow at both ends.
void KeyCurves::paintCurve(QPainter& painter, const KeyTrack& track, const Curve& curve) const {
    constexpr int kPieces = 12;
    const std::vector<QPointF>& points = curve.points;
    if (points.empty()) return;
    QPolygonF drawn;
    drawn << QPointF(kNames_px - kRight_px, points.front().y());
    for (std::size_t k = 0; k < points.size(); ++k) {
        const QPointF here = points[k];
        drawn << here;
        if (k + 1 == points.size()) break;
        const QPointF next = points[k + 1];
        const KeyInterpolation between = interpolationOf(view().line(), {track, k});
        if (between == KeyInterpolation::step) drawn << QPointF(next.x(), here.y());
        if (between != KeyInterpolation::smooth) continue;
        for (int piece = 1; piece < kPieces; ++piece) {
            const double share = static_cast<double>(piece) / kPieces;
            const double eased = smoothStep(share);
            drawn << QPointF(here.x() + share * (next.x() - here.x()),
                             here.y() + eased * (next.y() - here.y()));
        }
    }
    drawn << QPointF(width(), points.back().y());
    painter.setPen(QPen(curve.colour, 1.5));
    painter.setBrush(Qt::NoBrush);
    painter.drawPolyline(drawn);
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (points[k].x() < 0 || points[k].x() > width()) continue;
        const bool chosen = view().isSelected({track, k});
        painter.setBrush(chosen ? colours().caution : curve.colour);
        const double radius = chosen ? kPoint_px + 1 : kPoint_px;
        painter.drawEllipse(points[k], radius, radius);
    }
}

void KeyCurves::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.fillRect(keysArea(), colours().field);
    const std::vector<Curve> shown = curves();
    paintNames(painter, shown);
    painter.setClipRect(keysArea());
    if (shown.empty()) {
        painter.setPen(colours().dimText);
        painter.drawText(keysArea(), Qt::AlignCenter, "Clips have no curve. Choose another row");
    }
    for (const Curve& curve : shown) paintCurve(painter, *view().current(), curve);
    paintPlayHead(painter);
    painter.setClipping(false);
    paintFocus(painter);
}

}  // namespace hairloom::editor
