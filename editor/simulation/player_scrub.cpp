// SPDX-License-Identifier: GPL-3.0-or-later
// The play head of the player: any time of the time line at once.

#include <cmath>

#include "core/simulation/rest_positions.h"
#include "core/simulation/time_line_motion.h"
#include "editor/document/words.h"
#include "editor/simulation/player.h"
#include "editor/simulation/player_requests.h"

namespace hairloom::editor {

float Player::lineTimeOf(double seconds) const {
    const TimeLine& line = timeLineOf(document_.groom());
    const auto behind = static_cast<float>(seconds);
    return motion_ == kTimeLine ? line.timeAt(behind) : line.start + behind;
}

float Player::lineTime() const {
    return scrubbed_ ? scrubbed_->time : lineTimeOf(time());
}

std::int64_t Player::lineFrame() const {
    const auto rate = static_cast<double>(timeLineOf(document_.groom()).framesPerSecond);
    return std::llround(static_cast<double>(lineTime()) * rate);
}

Player::Shown Player::shown() const {
    if (scrubbed_) return scrubbed_->shown;
    return frame_ ? Shown::simulated : Shown::rest;
}

const std::shared_ptr<const HairPose>& Player::pose() const {
    static const std::shared_ptr<const HairPose> none;
    if (scrubbed_) return scrubbed_->pose;
    return frame_ ? frame_->pose : none;
}

bool Player::isAtLastFrame(float lineTime) const {
    if (!frame_) return false;
    return cache_->frameAt(lineTime) == cache_->frameAt(lineTimeOf(frame_->time));
}

void Player::scrub(float lineTime) {
    if (playing_) pause();
    const float time = std::clamp(lineTime, 0.0f, kLatestKey);
    Scrubbed now{time, Shown::posed, nullptr};
    // Whoever moved the head by hand is about to key it.
    const bool byHand = !offset_.isApprox(Eigen::Isometry3f::Identity());
    if (!byHand && isAtLastFrame(time)) {
        now.shown = Shown::simulated;
        now.pose = frame_->pose;
    } else if (auto played = byHand ? nullptr : cache_->at(cache_->frameAt(time))) {
        now.shown = Shown::played;
        now.pose = std::move(played);
    } else {
        now.pose = posedAt(time);
    }
    scrubbed_ = std::move(now);
    Q_EMIT frameReady();
    Q_EMIT playHeadMoved();
}

void Player::stepForward() {
    scrubbed_ && scrubbed_->shown != Shown::simulated ? scrubFrames(1) : step();
}

std::shared_ptr<const HairPose> Player::posedAt(float lineTime) {
    const Groom& groom = document_.groom();
    const TimeLine& line = timeLineOf(groom);
    // Outside of the range nothing plays, but its keys and clips are there to be seen.
    const bool isOutside = motion_ == kTimeLine && (lineTime < line.start || lineTime > line.end);
    TimeLine all = line;
    all.start = 0;
    all.loop = false;
    const auto motion = isOutside ? makeTimeLineMotion(std::move(all), actor_, groom) : makeMotion(motion_);
    if (!motion) {
        Q_EMIT failed(errorText(motion.error()));
        return nullptr;
    }
    auto pose = std::make_shared<HairPose>();
    pose->head = inWorld((*motion)->poseAt(isOutside ? lineTime : std::max(0.0f, lineTime - line.start)));
    moveBy(offset_, pose->head);
    pose->positions_ws = posedPositions(groom, pose->head);
    if (motion_ == kTimeLine) pose->lineTime = lineTime;
    return pose;
}

void Player::scrubFrames(std::int64_t frames) {
    const TimeLine& line = timeLineOf(document_.groom());
    const auto frame = static_cast<double>(std::max<std::int64_t>(lineFrame() + frames, 0));
    scrub(static_cast<float>(frame / static_cast<double>(line.framesPerSecond)));
}

void Player::endScrub() {
    if (!scrubbed_) return;
    scrubbed_.reset();
    Q_EMIT frameReady();
    Q_EMIT playHeadMoved();
}

void Player::clearCache() {
    cache_ = std::make_shared<FrameCache>(timeLineOf(document_.groom()));
    // After what is asked of the worker: it adds no frame of before. Other motions have no end, and neither
    // would the memory of their frames.
    request([&](WorkerRequests& requests) { requests.cache = motion_ == kTimeLine ? cache_ : nullptr; });
}

void Player::setHeadOffset(const Eigen::Isometry3f& offset) {
    offset_ = offset;
    request([&](WorkerRequests& requests) { requests.offset = offset; });
    if (scrubbed_) scrub(scrubbed_->time);
    Q_EMIT headOffsetChanged();
}

}  // namespace hairloom::editor
