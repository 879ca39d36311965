// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/time_line_view.h"

#include <algorithm>
#include <cmath>

namespace hairloom::editor {

TimeLineView::TimeLineView(Keying& keying, QObject* parent) : QObject(parent), keying_(keying) {
    connect(&keying_, &Keying::changed, this, [this] {
        prune();
        const TimeLine& now = keying_.line();
        const bool isOther = now.start != fitted_.start || now.end != fitted_.end ||
                             now.preRoll != fitted_.preRoll || now.framesPerSecond != fitted_.framesPerSecond;
        if (isOther) return fit();
        Q_EMIT changed();
    });
    connect(&player(), &Player::frameReady, this, &TimeLineView::changed);
    fit();
}

double TimeLineView::toX_px(double time, int width) const {
    const double room = std::max(1, width - kNames_px - kRight_px);
    return kNames_px + (time - first_) / (last_ - first_) * room;
}

double TimeLineView::toTime(double x_px, int width) const {
    const double room = std::max(1, width - kNames_px - kRight_px);
    return first_ + (x_px - kNames_px) / room * (last_ - first_);
}

float TimeLineView::toFrameTime(double x_px, int width) const {
    const double rate = static_cast<double>(line().framesPerSecond);
    return static_cast<float>(std::max(0.0, std::round(toTime(x_px, width) * rate)) / rate);
}

std::int64_t TimeLineView::frameOf(double time) const {
    return std::llround(time * static_cast<double>(line().framesPerSecond));
}

void TimeLineView::fit() {
    const TimeLine& line = this->line();
    const double preRoll = static_cast<double>(line.preRoll) / static_cast<double>(line.framesPerSecond);
    double last = static_cast<double>(line.end);
    for (const KeyTrack& track : tracksOf(line)) {
        const std::vector<float> times = keyTimes(line, track);
        if (!times.empty()) last = std::max(last, static_cast<double>(times.back()));
    }
    first_ = static_cast<double>(line.start) - preRoll;
    last_ = std::max(last, first_ + 1 / static_cast<double>(line.framesPerSecond));
    const double margin = 0.02 * (last_ - first_);
    first_ -= margin;
    last_ += margin;
    fitted_ = line;
    Q_EMIT changed();
}

void TimeLineView::zoom(double factor, double about) {
    const double span = std::clamp((last_ - first_) * factor, 4 / static_cast<double>(line().framesPerSecond),
                                   static_cast<double>(kLatestKey));
    const double share = (about - first_) / (last_ - first_);
    first_ = about - share * span;
    last_ = first_ + span;
    Q_EMIT changed();
}

bool TimeLineView::isSelected(const KeyPlace& key) const {
    return std::ranges::find(selection_, key) != selection_.end();
}

void TimeLineView::select(std::vector<KeyPlace> keys) {
    selection_ = std::move(keys);
    if (!selection_.empty()) current_ = selection_.back().track;
    Q_EMIT changed();
}

std::optional<KeyTrack> TimeLineView::current() const {
    const std::vector<KeyTrack> tracks = tracksOf(line());
    if (tracks.empty()) return std::nullopt;
    const auto found = std::ranges::find(tracks, current_);
    return found == tracks.end() ? tracks.front() : *found;
}

void TimeLineView::setCurrent(const KeyTrack& track) {
    current_ = track;
    Q_EMIT changed();
}

void TimeLineView::drag(TimeLine to, std::vector<KeyPlace> selection) {
    if (!dragged_) selectionBefore_ = selection_;
    dragged_ = std::move(to);
    selection_ = std::move(selection);
    Q_EMIT changed();
}

void TimeLineView::drop(const QString& name) {
    if (!dragged_) return;
    TimeLine to = std::move(*dragged_);
    dragged_.reset();
    if (!keying_.change(std::move(to), name)) selection_ = selectionBefore_;
    prune();
    Q_EMIT changed();
}

void TimeLineView::cancelDrag() {
    if (!dragged_) return;
    dragged_.reset();
    selection_ = selectionBefore_;
    Q_EMIT changed();
}

void TimeLineView::prune() {
    if (dragged_) return;
    std::erase_if(selection_, [&](const KeyPlace& key) {
        return key.index >= keyTimes(keying_.line(), key.track).size();
    });
}

void TimeLineView::removeSelected() {
    if (selection_.empty()) return;
    TimeLine to = keying_.line();
    removeKeys(to, selection_);
    selection_.clear();
    keying_.change(std::move(to), "Delete keys");
}

void TimeLineView::copySelectedHere() {
    TimeLine to = keying_.line();
    std::vector<KeyPlace> copies = copyKeys(to, selection_, player().lineTime());
    if (copies.empty() || !keying_.change(std::move(to), "Copy keys")) return;
    select(std::move(copies));
}

void TimeLineView::moveSelected(std::int64_t frames) {
    if (selection_.empty()) return;
    TimeLine to = keying_.line();
    std::vector<KeyPlace> moved = moveKeys(to, selection_, frames);
    if (keying_.change(std::move(to), "Move keys")) select(std::move(moved));
}

void TimeLineView::interpolateSelected(KeyInterpolation interpolation) {
    if (selection_.empty()) return;
    TimeLine to = keying_.line();
    setInterpolation(to, selection_, interpolation);
    keying_.change(std::move(to), "Interpolation of keys");
}

void TimeLineView::goToKey(int direction) {
    const auto track = current();
    if (!track) return;
    const std::vector<float> times = keyTimes(line(), *track);
    const float now = player().lineTime(), half = 0.5f / line().framesPerSecond;
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (direction > 0 && times[k] > now + half) {
            found = k;
            break;
        }
        if (direction < 0 && times[k] < now - half) found = k;
    }
    if (!found) return;
    player().scrub(times[*found]);
    select({{*track, *found}});
}

void TimeLineView::paintPlayHead(QPainter& painter, const QRect& area) const {
    const double x = toX_px(static_cast<double>(player().lineTime()), area.width());
    if (x < kNames_px || x > area.width()) return;
    // Of another colour where nothing was simulated.
    const QColor colour =
        player().shown() == Player::Shown::posed ? QColor(0xd9, 0x8a, 0x2b) : QColor(0x4c, 0x8d, 0xff);
    painter.setPen(QPen(colour, 2));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
}

}  // namespace hairloom::editor
