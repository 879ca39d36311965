// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/track_rows.h"

#include <QContextMenuEvent>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QStyle>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "editor/panels/key_form.h"
#include "editor/panels/time_ruler.h"

namespace hairloom::editor {
namespace {

constexpr double kReach_px = 7, kEdge_px = 5, kDiamond_px = 5.5, kDragFrom_px = 3;

QPolygonF diamond(const QPointF& at) {
    return QPolygonF({at + QPointF(0, -kDiamond_px), at + QPointF(kDiamond_px, 0),
                      at + QPointF(0, kDiamond_px), at + QPointF(-kDiamond_px, 0)});
}

}  // namespace

TrackRows::TrackRows(TimeLineView& view, QWidget* parent) : QWidget(parent), view_(view) {
    setObjectName("timeTracks");
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setAccessibleName("Keys and clips");
    setToolTip(
        "Drag keys to move them, double-click one to edit its value, drag over several to select them. "
        "Ctrl+D copies them to the play head, Delete removes them, Alt and the arrow keys move them by a "
        "frame. Up and down choose a row, Ctrl and left or right go to its keys. Drag a clip to move it, "
        "and its ends to trim it");
    connect(&view_, &TimeLineView::changed, this, &TrackRows::refit);
    refit();
}

void TrackRows::refit() {
    const auto rows = static_cast<int>(tracksOf(view_.line()).size());
    setMinimumHeight(std::max(1, rows) * kRow_px);
    update();
}

QPoint TrackRows::placeOf(const KeyPlace& key) const {
    const std::vector<KeyTrack> tracks = tracksOf(view_.line());
    const auto row = std::ranges::find(tracks, key.track) - tracks.begin();
    const double time = static_cast<double>(keyTimes(view_.line(), key.track)[key.index]);
    return QPointF(view_.toX_px(time, width()), (static_cast<double>(row) + 0.5) * kRow_px).toPoint();
}

std::optional<std::size_t> TrackRows::rowAt(double y) const {
    const auto row = static_cast<std::int64_t>(std::floor(y / kRow_px));
    if (row < 0 || row >= static_cast<std::int64_t>(tracksOf(view_.line()).size())) return std::nullopt;
    return static_cast<std::size_t>(row);
}

/// Until the next clip starts or its range has played; what repeats plays to the end of the line.
QRectF TrackRows::barOf(std::size_t clip) const {
    const TimeLine& line = view_.line();
    const ClipStrip& strip = line.clips[clip];
    double end = std::max(static_cast<double>(line.end), static_cast<double>(strip.start) + 0.1);
    const double length = clipLength(strip, view_.player());
    if (!strip.loop && strip.speed > 0 && length > 0)
        end = static_cast<double>(strip.start) + length / static_cast<double>(strip.speed);
    if (clip + 1 < line.clips.size()) end = std::min(end, static_cast<double>(line.clips[clip + 1].start));
    const double left = view_.toX_px(static_cast<double>(strip.start), width());
    const double right = view_.toX_px(end, width());
    return {left, 3, std::max(right - left, 4.0), kRow_px - 6.0};
}

std::optional<TrackRows::Hit> TrackRows::hitAt(const QPointF& place) const {
    const auto row = rowAt(place.y());
    if (!row || place.x() < TimeLineView::kNames_px - kReach_px) return std::nullopt;
    const KeyTrack track = tracksOf(view_.line())[*row];
    if (track.of == KeyTrack::Of::clips) {
        for (std::size_t c = view_.line().clips.size(); c-- > 0;) {
            const QRectF bar = barOf(c);
            if (place.x() < bar.left() - kEdge_px || place.x() > bar.right() + kEdge_px) continue;
            if (place.x() < bar.left() + kEdge_px) return Hit{{track, c}, Part::leftEdge};
            if (place.x() > bar.right() - kEdge_px) return Hit{{track, c}, Part::rightEdge};
            return Hit{{track, c}, Part::body};
        }
        return std::nullopt;
    }
    const std::vector<float> times = keyTimes(view_.line(), track);
    std::optional<Hit> found;
    double least = kReach_px;
    for (std::size_t k = 0; k < times.size(); ++k) {
        const double distance = std::abs(view_.toX_px(static_cast<double>(times[k]), width()) - place.x());
        if (distance > least) continue;
        least = distance;
        found = Hit{{track, k}, Part::body};
    }
    return found;
}

void TrackRows::choose(const KeyPlace& key, Qt::KeyboardModifiers modifiers) {
    std::vector<KeyPlace> keys;
    const bool more = (modifiers & (Qt::ShiftModifier | Qt::ControlModifier)) != 0;
    if (more) keys = view_.selection();
    if (view_.isSelected(key)) {
        if (more)
            std::erase(keys, key);
        else
            return;  // what is selected is dragged together
    } else {
        keys.push_back(key);
    }
    view_.select(std::move(keys));
}

void TrackRows::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    from_ = event->position();
    if (const auto row = rowAt(from_.y())) view_.setCurrent(tracksOf(view_.line())[*row]);
    held_ = hitAt(from_);
    band_.reset();
    if (held_) {
        choose(held_->key, event->modifiers());
        heldKeys_ = view_.selection();
    } else if (!(event->modifiers() & (Qt::ShiftModifier | Qt::ControlModifier))) {
        view_.select({});
    }
}

void TrackRows::mouseMoveEvent(QMouseEvent* event) {
    const QPointF place = event->position();
    if (!(event->buttons() & Qt::LeftButton)) {
        const auto hit = hitAt(place);
        const bool edge = hit && hit->part != Part::body;
        setCursor(edge ? Qt::SizeHorCursor : hit ? Qt::PointingHandCursor : Qt::ArrowCursor);
        return;
    }
    if (!view_.isDragging() && !band_ && (place - from_).manhattanLength() < kDragFrom_px) return;
    if (held_) return dragTo(place);
    band_ = QRectF(from_, place).normalized();
    update();
}

void TrackRows::dragTo(const QPointF& place) {
    TimeLine to = view_.keying().line();
    const double by = view_.toTime(place.x(), width()) - view_.toTime(from_.x(), width());
    if (held_->part == Part::body || held_->key.track.of != KeyTrack::Of::clips) {
        std::vector<KeyPlace> moved = moveKeys(to, heldKeys_, view_.frameOf(by));
        return view_.drag(std::move(to), std::move(moved));
    }
    const bool isStart = held_->part == Part::leftEdge;
    trimClip(to, held_->key.index, isStart, static_cast<double>(view_.toFrameTime(place.x(), width())),
             view_.player());
    view_.drag(std::move(to), {held_->key});
}

void TrackRows::selectInBand() {
    const std::vector<KeyTrack> tracks = tracksOf(view_.line());
    std::vector<KeyPlace> keys;
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        const std::size_t count = keyTimes(view_.line(), tracks[row]).size();
        for (std::size_t k = 0; k < count; ++k) {
            const KeyPlace key{tracks[row], k};
            if (band_->contains(QPointF(placeOf(key)))) keys.push_back(key);
        }
    }
    view_.select(std::move(keys));
}

void TrackRows::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    const bool isClip = held_ && held_->key.track.of == KeyTrack::Of::clips;
    if (view_.isDragging())
        view_.drop(!isClip ? "Move keys" : held_->part == Part::body ? "Move clip" : "Trim clip");
    if (band_) selectInBand();
    band_.reset();
    held_.reset();
    update();
}

void TrackRows::mouseDoubleClickEvent(QMouseEvent* event) {
    const auto hit = hitAt(event->position());
    if (!hit) return;
    view_.select({hit->key});
    Q_EMIT view_.editRequested();
}

void TrackRows::contextMenuEvent(QContextMenuEvent* event) {
    if (event->reason() == QContextMenuEvent::Mouse) {
        const auto hit = hitAt(event->pos());
        if (hit && !view_.isSelected(hit->key)) view_.select({hit->key});
    }
    if (view_.selection().empty()) return;
    QMenu menu;
    menu.addAction("Edit value", this, [this] { Q_EMIT view_.editRequested(); });
    QMenu* between = menu.addMenu("Interpolation");
    for (std::uint8_t i = 0; i < std::size(kKeyInterpolations); ++i)
        between->addAction(labelOf(QString(kKeyInterpolations[i])), this,
                           [this, i] { view_.interpolateSelected(static_cast<KeyInterpolation>(i)); });
    menu.addAction("Copy to play head", this, [this] { view_.copySelectedHere(); });
    menu.addAction("Delete", this, [this] { view_.removeSelected(); });
    menu.exec(event->globalPos());
}

void TrackRows::wheelEvent(QWheelEvent* event) {
    if (!(event->modifiers() & Qt::ControlModifier)) return event->ignore();
    view_.zoom(event->angleDelta().y() > 0 ? 0.8 : 1.25, view_.toTime(event->position().x(), width()));
}

bool TrackRows::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride && isTimeLineKey(*static_cast<QKeyEvent*>(event))) {
        event->accept();
        return true;
    }
    return QWidget::event(event);
}

void TrackRows::moveRow(int by) {
    const std::vector<KeyTrack> tracks = tracksOf(view_.line());
    const auto current = view_.current();
    if (!current) return;
    const auto row = std::ranges::find(tracks, *current) - tracks.begin() + by;
    if (row >= 0 && row < static_cast<std::ptrdiff_t>(tracks.size()))
        view_.setCurrent(tracks[static_cast<std::size_t>(row)]);
}

void TrackRows::keyPressEvent(QKeyEvent* event) {
    const bool left = event->key() == Qt::Key_Left, right = event->key() == Qt::Key_Right;
    if ((left || right) && event->modifiers() == Qt::ControlModifier) return view_.goToKey(right ? 1 : -1);
    if ((left || right) && event->modifiers() == Qt::AltModifier) return view_.moveSelected(right ? 1 : -1);
    switch (event->key()) {
        case Qt::Key_Up:
            return moveRow(-1);
        case Qt::Key_Down:
            return moveRow(1);
        case Qt::Key_Delete:
        case Qt::Key_Backspace:
            return view_.removeSelected();
        case Qt::Key_Return:
        case Qt::Key_Enter:
            Q_EMIT view_.editRequested();
            return;
        case Qt::Key_Escape:
            held_.reset();
            return view_.isDragging() ? view_.cancelDrag() : view_.select({});
        case Qt::Key_D:
            return view_.copySelectedHere();
        case Qt::Key_A: {
            std::vector<KeyPlace> all;
            for (const KeyTrack& track : tracksOf(view_.line())) {
                for (std::size_t k = 0; k < keyTimes(view_.line(), track).size(); ++k)
                    all.push_back({track, k});
            }
            return view_.select(std::move(all));
        }
        default:
            if (!stepByKey(view_, *event)) QWidget::keyPressEvent(event);
    }
}

void TrackRows::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const TimeLine& line = view_.line();
    const std::vector<KeyTrack> tracks = tracksOf(line);
    const auto current = view_.current();
    const QColor text = palette().color(QPalette::Text), lit = palette().color(QPalette::Highlight);
    QColor chosenRow = lit;
    chosenRow.setAlpha(46);
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        const KeyTrack& track = tracks[row];
        const QRectF area(0, static_cast<double>(row) * kRow_px, width(), kRow_px);
        if (current == track) painter.fillRect(area, chosenRow);
        painter.setPen(text);
        const QRectF name = area.adjusted(8, 0, TimeLineView::kNames_px - 16 - width(), 0);
        painter.drawText(
            name, Qt::AlignVCenter,
            fontMetrics().elidedText(labelOf(track), Qt::ElideRight, static_cast<int>(name.width())));
        painter.save();
        painter.setClipRect(area.adjusted(TimeLineView::kNames_px - kDiamond_px, 0, 0, 0));
        painter.setPen(palette().color(QPalette::Mid));
        painter.drawLine(QPointF(0, area.center().y()), QPointF(width(), area.center().y()));
        if (track.of == KeyTrack::Of::clips) {
            for (std::size_t c = 0; c < line.clips.size(); ++c) {
                const QRectF bar = barOf(c).translated(0, area.top());
                const bool chosen = view_.isSelected({track, c});
                QColor fill = lit;
                fill.setAlpha(chosen ? 220 : 110);
                painter.setBrush(fill);
                painter.setPen(chosen ? text : lit);
                painter.drawRoundedRect(bar, 3, 3);
                if (line.clips[c].blend > 0) {
                    const double blended = static_cast<double>(line.clips[c].start + line.clips[c].blend);
                    painter.drawLine(bar.bottomLeft(), QPointF(view_.toX_px(blended, width()), bar.top()));
                }
                painter.setPen(text);
                painter.drawText(bar.adjusted(6, 0, -2, 0), Qt::AlignVCenter,
                                 QString::fromStdString(line.clips[c].name));
            }
        } else {
            const std::vector<float> times = keyTimes(line, track);
            for (std::size_t k = 0; k < times.size(); ++k) {
                const bool chosen = view_.isSelected({track, k});
                painter.setBrush(chosen ? QColor(0xf2, 0xb1, 0x34) : text);
                painter.setPen(palette().color(QPalette::Window));
                painter.drawPolygon(
                    diamond({view_.toX_px(static_cast<double>(times[k]), width()), area.center().y()}));
            }
        }
        painter.restore();
    }
    view_.paintPlayHead(painter, rect());
    if (band_) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(text, 1, Qt::DashLine));
        painter.drawRect(*band_);
    }
    if (!hasFocus()) return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(lit);
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

}  // namespace hairloom::editor
