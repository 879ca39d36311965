// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/take_view.h"

#include <algorithm>

#include "core/documents/motions.h"
#include "core/documents/takes.h"
#include "core/groom/time_line.h"
#include "editor/document/words.h"
#include "editor/overlays/overlay_mode.h"

namespace hairloom::editor {
namespace {

constexpr int kTakeTick_ms = 16;

}  // namespace

TakeView::TakeView(const PanelParts& parts, QObject* parent)
    : QObject(parent), document_(parts.document), player_(parts.player), viewport_(parts.viewport) {
    timer_.setInterval(kTakeTick_ms);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &TakeView::advance);
    connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
        if (contains(changed, editing::kHairParts | editing::kScalpParts | editing::Part::Spheres)) stop();
    });
    connect(&document_, &QtDocument::replaced, this, &TakeView::stop);
    connect(&player_, &Player::stateChanged, this, [this] {
        if (player_.isPlaying()) stop();
    });
    connect(&player_, &Player::playHeadMoved, this, &TakeView::followPlayHead);
    viewport_.addMarks([this](Marks& marks) { draw(marks); });
}

Status TakeView::show(const std::filesystem::path& take) {
    auto opened = openTakeFor(take, document_.groom());
    if (!opened) {
        stop();
        return tl::unexpected(opened.error());
    }
    if (opened->info().frames == 0) {
        stop();
        return failIn(take.string(), {}, "has no frames", "expected a take that was recorded");
    }
    player_.pause();
    take_ = std::move(*opened);
    frame_.reset();
    otherFrame_.reset();
    showFrame(0);
    return {};
}

Status TakeView::compareWith(const std::filesystem::path& other) {
    other_.reset();
    Status status;
    if (!other.empty()) {
        auto opened = openTakeFor(other, document_.groom());
        if (opened)
            other_ = std::move(*opened);
        else
            status = tl::unexpected(opened.error());
    }
    if (take_) showFrame(number_);
    return status;
}

void TakeView::stop() {
    const bool was = isShown();
    timer_.stop();
    take_.reset();
    other_.reset();
    frame_.reset();
    otherFrame_.reset();
    number_ = 0;
    if (!was) return;
    viewport_.setPose(player_.pose());
    Q_EMIT playingChanged();
    Q_EMIT stopped();
}

void TakeView::showFrame(std::uint64_t number) {
    if (!take_) return;
    number_ = std::min(number, take_->info().frames - 1);
    auto frame = take_->frame(number_);
    if (!frame) {
        setPlaying(false);
        frame_.reset();
        otherFrame_.reset();
        Q_EMIT failed(errorText(frame.error()));
        return;
    }
    frame_ = std::move(*frame);
    otherFrame_.reset();
    if (other_ && number_ < other_->info().frames) {
        if (auto beside = other_->frame(number_))
            otherFrame_ = std::move(*beside);
        else
            Q_EMIT failed(errorText(beside.error()));
    }
    auto pose = std::make_shared<HairPose>();
    pose->positions_ws = frame_->positions_ws;
    pose->head = frame_->pose;
    if (const auto seconds = timeLineSeconds(take_->info(), number_))
        pose->lineTime = timeLineOf(document_.groom()).timeAt(*seconds);
    viewport_.setPose(std::move(pose));
    Q_EMIT frameShown(number_);
}

void TakeView::followPlayHead() {
    if (!take_ || !player_.isScrubbed() || motionOfNotes(take_->info().notes) != kTimeLineMotion) return;
    setPlaying(false);
    const TimeLine& line = timeLineOf(document_.groom());
    showFrame(frameAtTimeLine(take_->info(), player_.lineTime() - line.start));
}

void TakeView::startClock() {
    from_ = number_;
    clock_.start();
}

void TakeView::setPlaying(bool on) {
    if (on == isPlaying() || (on && !take_)) return;
    if (on) {
        startClock();
        timer_.start();
    } else {
        timer_.stop();
    }
    Q_EMIT playingChanged();
}

void TakeView::setSpeed(double factor) {
    speed_ = factor;
    startClock();
}

/// The frame that is due: where pictures take longer some are left out, and the time is right.
void TakeView::advance() {
    const double played = static_cast<double>(clock_.nsecsElapsed()) * 1e-9 * speed_ *
                          static_cast<double>(take_->info().framesPerSecond);
    const std::uint64_t due = (from_ + static_cast<std::uint64_t>(played)) % take_->info().frames;
    if (due != number_) showFrame(due);
}

bool TakeView::isCompared() const {
    return frame_ && otherFrame_ && frame_->positions_ws.size() == document_.groom().pointCount() &&
           otherFrame_->positions_ws.size() == frame_->positions_ws.size();
}

std::optional<TakeView::Distance> TakeView::distance() const {
    if (!isCompared()) return std::nullopt;
    const auto &here = frame_->positions_ws, &there = otherFrame_->positions_ws;
    Distance distance;
    for (std::size_t i = 0; i < here.size(); ++i) {
        const auto away = static_cast<double>((here[i] - there[i]).norm());
        distance.mean += away;
        distance.largest = std::max(distance.largest, away);
    }
    if (!here.empty()) distance.mean /= static_cast<double>(here.size());
    return distance;
}

void TakeView::draw(Marks& marks) const {
    if (!isCompared()) return;
    const Groom& groom = document_.groom();
    const auto &here = frame_->positions_ws, &there = otherFrame_->positions_ws;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (std::uint32_t p = groom.offsets[s] + 1; p < groom.offsets[s + 1]; ++p)
            marks.line(here[p - 1], here[p], heat((here[p] - there[p]).norm() / kRedDistance), 1);
    }
}

}  // namespace hairloom::editor
