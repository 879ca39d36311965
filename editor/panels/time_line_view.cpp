// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/time_line_view.h"

#include <algorithm>
#include <cmath>

namespace hairloom::editor {

TimeLineView::TimeLineView(Keying& keying, const Preferences& preferences, QObject* parent)
    : QObject(parent), keying_(keying), preferences_(preferences) {
    connect(&keying_, &Keying::replaced, this, [this] {
        dragged_.reset();
        setSelection({});
        fit();
    });
    connect(&keying_, &Keying::lineChanged, this, [this] {
        cancelDrag();
        Q_EMIT interrupted();
    });
    connect(&keying_, &Keying::changed, this, [this] {
        prune();
        const TimeLine& now = keying_.line();
        const bool isOther = now.start != fitted_.start || now.end != fitted_.end ||
                             now.preRoll != fitted_.preRoll || now.framesPerSecond != fitted_.framesPerSecond;
        if (isOther) return fit();
        announce();
    });
    connect(&player(), &Player::playHeadMoved, this,
            [this] { reveal(static_cast<double>(player().lineTime())); });
    connect(&player(), &Player::frameReady, this, &TimeLineView::announce);
    connect(&preferences_, &Preferences::changed, this, &TimeLineView::announce);
    fit();
}

std::int64_t TimeLineView::frameOf(double time) const {
    return std::llround(time * static_cast<double>(line().framesPerSecond));
}

void TimeLineView::fit() {
    const TimeLine& line = this->line();
    const double preRoll = static_cast<double>(line.preRoll) / static_cast<double>(line.framesPerSecond);
    last_ = static_cast<double>(line.end);
    // Of a long pre-roll its end: the range is what people work on.
    first_ = static_cast<double>(line.start);
    first_ -= std::min(preRoll, 0.3 * (last_ - first_));
    for (const KeyTrack& track : tracksOf(line)) {
        const std::vector<float> times = keyTimes(line, track);
        if (times.empty()) continue;
        first_ = std::min(first_, static_cast<double>(times.front()));
        last_ = std::max(last_, static_cast<double>(times.back()));
    }
    last_ = std::max(last_, first_ + 1 / static_cast<double>(line.framesPerSecond));
    const double margin = 0.02 * (last_ - first_);
    first_ -= margin;
    last_ += margin;
    fitted_.start = line.start;
    fitted_.end = line.end;
    fitted_.preRoll = line.preRoll;
    fitted_.framesPerSecond = line.framesPerSecond;
    announce();
}

void TimeLineView::zoom(double factor, double about) {
    const double span = std::clamp((last_ - first_) * factor, 4 / static_cast<double>(line().framesPerSecond),
                                   static_cast<double>(kLatestKey));
    const double share = (about - first_) / (last_ - first_);
    first_ = about - share * span;
    last_ = first_ + span;
    announce();
}

void TimeLineView::pan(double by) {
    const double span = last_ - first_;
    first_ = std::clamp(first_ + by, -span, static_cast<double>(kLatestKey));
    last_ = first_ + span;
    announce();
}

void TimeLineView::reveal(double time) {
    const double margin = 0.02 * (last_ - first_);
    if (time < first_ + margin) pan(std::max(time, 0.0) - margin - first_);
    if (time > last_ - margin) pan(time + margin - last_);
}

void TimeLineView::setSelection(std::vector<KeyPlace> keys) {
    selection_ = std::move(keys);
    selected_ = {selection_.begin(), selection_.end()};
}

bool TimeLineView::isSelected(const KeyPlace& key) const {
    return selected_.contains(key);
}

void TimeLineView::select(std::vector<KeyPlace> keys) {
    setSelection(std::move(keys));
    if (!selection_.empty()) current_ = selection_.back().track;
    announce();
}

void TimeLineView::selectAll() {
    std::vector<KeyPlace> all;
    for (const KeyTrack& track : tracksOf(line())) {
        const std::size_t count = keyTimes(line(), track).size();
        for (std::size_t k = 0; k < count; ++k) all.push_back({track, k});
    }
    select(std::move(all));
}

std::optional<KeyTrack> TimeLineView::current() const {
    const std::vector<KeyTrack> tracks = tracksOf(line());
    if (tracks.empty()) return std::nullopt;
    const auto found = std::ranges::find(tracks, current_);
    return found == tracks.end() ? tracks.front() : *found;
}

void TimeLineView::setCurrent(const KeyTrack& track) {
    current_ = track;
    announce();
}

void TimeLineView::moveRow(int by) {
    const std::vector<KeyTrack> tracks = tracksOf(line());
    const auto now = current();
    if (!now) return;
    const auto row = std::ranges::find(tracks, *now) - tracks.begin() + by;
    if (row >= 0 && row < static_cast<std::ptrdiff_t>(tracks.size()))
        setCurrent(tracks[static_cast<std::size_t>(row)]);
}

void TimeLineView::drag(TimeLine to, std::vector<KeyPlace> selection) {
    if (!dragged_) selectionBefore_ = selection_;
    dragged_ = std::move(to);
    setSelection(std::move(selection));
    announce();
}

void TimeLineView::drop(const QString& name) {
    if (!dragged_) return;
    TimeLine to = std::move(*dragged_);
    dragged_.reset();
    if (!keying_.change(std::move(to), name)) setSelection(selectionBefore_);
    prune();
    announce();
}

void TimeLineView::cancelDrag() {
    if (!dragged_) return;
    dragged_.reset();
    setSelection(selectionBefore_);
    announce();
}

void TimeLineView::announce() {
    // The player may speak of a new time line before Keying does.
    prune();
    Q_EMIT changed();
}

void TimeLineView::prune() {
    if (dragged_) return;
    std::vector<KeyPlace> left;
    for (const KeyPlace& key : selection_) {
        if (hasKey(keying_.line(), key)) left.push_back(key);
    }
    if (left.size() != selection_.size()) setSelection(std::move(left));
}

void TimeLineView::removeSelected() {
    if (selection_.empty()) return;
    TimeLine to = keying_.line();
    removeKeys(to, selection_);
    setSelection({});
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

void TimeLineView::insertKey(const KeyTrack& track, float time) {
    keying_.insertKey(track, time);
    if (const auto index = findKey(line(), track, time)) select({{track, *index}});
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

}  // namespace hairloom::editor
