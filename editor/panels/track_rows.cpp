// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/track_rows.h"

#include <QContextMenuEvent>
#include <QMenu>
#include <algorithm>
#include <cmath>

#include "editor/document/words.h"
#include "editor/panels/key_form.h"

namespace hairloom::editor {
namespace {

constexpr double kKeyReach_px = 7, kEdge_px = 5, kDiamond_px = 5.5;

QPolygonF diamond(const QPointF& at) {
    return QPolygonF({at + QPointF(0, -kDiamond_px), at + QPointF(kDiamond_px, 0),
                      at + QPointF(0, kDiamond_px), at + QPointF(-kDiamond_px, 0)});
}

}  // namespace

TrackRows::TrackRows(TimeLineView& view, QWidget* parent)
    : TimeLineWidget(view, "timeTracks", "Keys and clips", parent) {
    setToolTip(
        "Drag keys to move them, double-click one to edit its value, drag over several to select them. "
        "Double-click a row to add a key there. Ctrl+D copies keys to the play head, Delete removes them, "
        "Alt "
        "and the arrow keys move them by a frame. Up and down choose a row, Ctrl and left or right go to its "
        "keys. Drag a clip to move it, and its ends to trim it");
    connect(&view, &TimeLineView::changed, this, &TrackRows::refit);
    refit();
}

void TrackRows::refit() {
    const auto rows = static_cast<int>(tracksOf(view().line()).size());
    setMinimumHeight(std::max(1, rows) * kRow_px);
    update();
}

QPoint TrackRows::placeOf(const KeyPlace& key) const {
    const std::vector<KeyTrack> tracks = tracksOf(view().line());
    const auto row = std::ranges::find(tracks, key.track) - tracks.begin();
    const double time = static_cast<double>(keyTime(view().line(), key));
    return QPointF(toX_px(time), (static_cast<double>(row) + 0.5) * kRow_px).toPoint();
}

std::optional<std::size_t> TrackRows::rowAt(double y) const {
    const auto row = static_cast<std::int64_t>(std::floor(y / kRow_px));
    if (row < 0 || row >= static_cast<std::int64_t>(tracksOf(view().line()).size())) return std::nullopt;
    return static_cast<std::size_t>(row);
}

/// Until the next clip starts or its range has played; what repeats plays to the end of the line.
QRectF TrackRows::barOf(std::size_t clip) const {
    const TimeLine& line = view().line();
    const ClipStrip& strip = line.clips[clip];
    double end = std::max(static_cast<double>(line.end), static_cast<double>(strip.start) + 0.1);
    const double length = clipLength(strip, view().player());
    if (!strip.loop && strip.speed > 0 && length > 0)
        end = static_cast<double>(strip.start) + length / static_cast<double>(strip.speed);
    if (clip + 1 < line.clips.size()) end = std::min(end, static_cast<double>(line.clips[clip + 1].start));
    const double left = toX_px(static_cast<double>(strip.start));
    const double right = toX_px(end);
    return {left, 3, std::max(right - left, 4.0), kRow_px - 6.0};
}

std::optional<TrackRows::Hit> TrackRows::hitAt(const QPointF& place) const {
    const auto row = rowAt(place.y());
    if (!row || place.x() < kNames_px - kKeyReach_px) return std::nullopt;
    const KeyTrack track = tracksOf(view().line())[*row];
    if (track.of == KeyTrack::Of::clips) {
        for (std::size_t c = view().line().clips.size(); c-- > 0;) {
            const QRectF bar = barOf(c);
            if (place.x() < bar.left() - kEdge_px || place.x() > bar.right() + kEdge_px) continue;
            if (place.x() < bar.left() + kEdge_px) return Hit{{track, c}, Part::leftEdge};
            if (place.x() > bar.right() - kEdge_px) return Hit{{track, c}, Part::rightEdge};
            return Hit{{track, c}, Part::body};
        }
        return std::nullopt;
    }
    const std::vector<float> times = keyTimes(view().line(), track);
    std::optional<Hit> found;
    double least = kKeyReach_px;
    for (std::size_t k = 0; k < times.size(); ++k) {
        const double distance = std::abs(toX_px(static_cast<double>(times[k])) - place.x());
        if (distance > least) continue;
        least = distance;
        found = Hit{{track, k}, Part::body};
    }
    return found;
}

void TrackRows::choose(const KeyPlace& key, Qt::KeyboardModifiers modifiers) {
    std::vector<KeyPlace> keys;
    const bool more = (modifiers & (Qt::ShiftModifier | Qt::ControlModifier)) != 0;
    if (more) keys = view().selection();
    if (view().isSelected(key)) {
        if (more)
            std::erase(keys, key);
        else
            return;  // what is selected is dragged together
    } else {
        keys.push_back(key);
    }
    view().select(std::move(keys));
}

void TrackRows::press(QMouseEvent& event) {
    from_ = event.position();
    if (const auto row = rowAt(from_->y())) view().setCurrent(tracksOf(view().line())[*row]);
    held_ = hitAt(*from_);
    band_.reset();
    if (held_) {
        choose(held_->key, event.modifiers());
        heldKeys_ = view().selection();
    } else if (!(event.modifiers() & (Qt::ShiftModifier | Qt::ControlModifier))) {
        view().select({});
    }
}

void TrackRows::hover(QMouseEvent& event) {
    const auto hit = hitAt(event.position());
    const bool edge = hit && hit->part != Part::body;
    setCursor(edge ? Qt::SizeHorCursor : hit ? Qt::PointingHandCursor : Qt::ArrowCursor);
}

void TrackRows::dragged(QMouseEvent& event) {
    if (!from_) return;
    const QPointF place = event.position();
    if (!view().isDragging() && !band_ && (place - *from_).manhattanLength() < kDragFrom_px) return;
    if (held_) return dragTo(place);
    band_ = QRectF(*from_, place).normalized();
    update();
}

void TrackRows::dragTo(const QPointF& place) {
    TimeLine to = view().keying().line();
    if (held_->part == Part::body || held_->key.track.of != KeyTrack::Of::clips) {
        const double by = toTime(place.x()) - toTime(from_->x());
        std::vector<KeyPlace> moved = moveKeys(to, heldKeys_, view().frameOf(by));
        return view().drag(std::move(to), std::move(moved));
    }
    const bool isStart = held_->part == Part::leftEdge;
    trimClip(to, held_->key.index, isStart, static_cast<double>(toFrameTime(place.x())), view().player());
    view().drag(std::move(to), {held_->key});
}

void TrackRows::selectInBand() {
    const std::vector<KeyTrack> tracks = tracksOf(view().line());
    std::vector<KeyPlace> keys;
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        const std::size_t count = keyTimes(view().line(), tracks[row]).size();
        for (std::size_t k = 0; k < count; ++k) {
            const KeyPlace key{tracks[row], k};
            if (band_->contains(QPointF(placeOf(key)))) keys.push_back(key);
        }
    }
    view().select(std::move(keys));
}

void TrackRows::release(QMouseEvent&) {
    const bool isClip = held_ && held_->key.track.of == KeyTrack::Of::clips;
    if (view().isDragging())
        view().drop(!isClip ? "Move keys" : held_->part == Part::body ? "Move clip" : "Trim clip");
    if (band_) selectInBand();
    letGo();
}

void TrackRows::letGo() {
    band_.reset();
    held_.reset();
    from_.reset();
    update();
}

void TrackRows::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    if (const auto hit = hitAt(event->position())) {
        view().select({hit->key});
        Q_EMIT view().editRequested();
        return;
    }
    const auto row = rowAt(event->position().y());
    if (!row || event->position().x() < kNames_px) return;
    view().insertKey(tracksOf(view().line())[*row], toFrameTime(event->position().x()));
}

void TrackRows::contextMenuEvent(QContextMenuEvent* event) {
    if (event->reason() == QContextMenuEvent::Mouse) {
        const auto hit = hitAt(event->pos());
        if (hit && !view().isSelected(hit->key)) view().select({hit->key});
    }
    if (view().selection().empty()) return;
    QMenu menu;
    menu.addAction("Edit value", this, [this] { Q_EMIT view().editRequested(); });
    QMenu* between = menu.addMenu("Interpolation");
    for (std::uint8_t i = 0; i < std::size(kKeyInterpolations); ++i)
        between->addAction(labelOf(QString(kKeyInterpolations[i])), this,
                           [this, i] { view().interpolateSelected(static_cast<KeyInterpolation>(i)); });
    menu.addAction("Copy to play head", this, [this] { view().copySelectedHere(); });
    menu.addAction("Delete", this, [this] { view().removeSelected(); });
    menu.exec(event->globalPos());
}

void TrackRows::paintClip(QPainter& painter, std::size_t clip, double top) const {
    const ClipStrip& strip = view().line().clips[clip];
    const QRectF bar = barOf(clip).translated(0, top);
    const bool chosen = view().isSelected({{KeyTrack::Of::clips, {}}, clip});
    QColor fill = colours().accent;
    fill.setAlpha(chosen ? 220 : 110);
    painter.setBrush(fill);
    painter.setPen(chosen ? colours().text : colours().accent);
    painter.drawRoundedRect(bar, 3, 3);
    if (strip.blend > 0) {
        const double blended = static_cast<double>(strip.start + strip.blend);
        painter.setPen(colours().text);
        painter.drawLine(bar.bottomLeft(), QPointF(toX_px(blended), bar.top()));
    }
    painter.setPen(colours().text);
    const QRectF words = bar.adjusted(6, 0, -4, 0);
    painter.drawText(words, Qt::AlignVCenter,
                     fontMetrics().elidedText(QString::fromStdString(strip.name), Qt::ElideRight,
                                              static_cast<int>(words.width())));
}

void TrackRows::paintRow(QPainter& painter, const KeyTrack& track, const QRectF& area) const {
    if (view().current() == track) {
        QColor chosenRow = colours().accent;
        chosenRow.setAlpha(46);
        painter.fillRect(area, chosenRow);
    }
    const QRectF name = area.adjusted(8, 0, kNames_px - 16 - width(), 0);
    painter.setPen(colours().text);
    painter.drawText(
        name, Qt::AlignVCenter,
        fontMetrics().elidedText(labelOf(track), Qt::ElideRight, static_cast<int>(name.width())));
    painter.save();
    painter.setClipRect(keysArea());
    painter.setPen(palette().color(QPalette::Mid));
    painter.drawLine(QPointF(0, area.center().y()), QPointF(width(), area.center().y()));
    if (track.of == KeyTrack::Of::clips) {
        for (std::size_t c = 0; c < view().line().clips.size(); ++c) paintClip(painter, c, area.top());
    } else {
        const std::vector<float> times = keyTimes(view().line(), track);
        painter.setPen(palette().color(QPalette::Window));
        for (std::size_t k = 0; k < times.size(); ++k) {
            const double x = toX_px(static_cast<double>(times[k]));
            if (x < 0 || x > width()) continue;
            painter.setBrush(view().isSelected({track, k}) ? colours().caution : colours().text);
            painter.drawPolygon(diamond({x, area.center().y()}));
        }
    }
    painter.restore();
}

void TrackRows::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const std::vector<KeyTrack> tracks = tracksOf(view().line());
    for (std::size_t row = 0; row < tracks.size(); ++row)
        paintRow(painter, tracks[row],
                 {0, static_cast<double>(row) * kRow_px, static_cast<double>(width()), kRow_px});
    paintPlayHead(painter);
    if (band_) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(colours().text, 1, Qt::DashLine));
        painter.drawRect(*band_);
    }
    paintFocus(painter);
}

}  // namespace hairloom::editor
