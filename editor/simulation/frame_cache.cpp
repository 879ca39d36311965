// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/frame_cache.h"

#include <cmath>
#include <iterator>

namespace hairloom::editor {
namespace {

std::size_t bytesOf(const HairPose& pose) {
    constexpr std::size_t kNodes = 160;  // of both maps, and what counts references
    const auto of = [](const auto& values) { return values.size() * sizeof(values[0]); };
    return of(pose.positions_ws) + of(pose.velocities_ws) + of(pose.head.scalpPositions_ws) +
           of(pose.head.morphed_ss) + of(pose.head.bones_ws) + of(pose.head.body_ws) +
           of(pose.head.sphereCentres_ws) + sizeof(pose) + kNodes;
}

}  // namespace

FrameCache::FrameCache(const TimeLine& line, std::size_t mostBytes) : mostBytes_(mostBytes) {
    range_.framesPerSecond = line.framesPerSecond;
    range_.start = line.start;
    range_.end = line.end;
    range_.loop = line.loop;
}

std::int64_t FrameCache::frameAt(float lineTime) const {
    return std::llround(static_cast<double>(lineTime) * static_cast<double>(range_.framesPerSecond));
}

void FrameCache::remove(Frames::iterator frame) {
    bytes_ -= bytesOf(*frame->second.pose);
    byAge_.erase(frame->second.age);
    takeFromRuns(frame->first);
    frames_.erase(frame);
}

void FrameCache::addToRuns(std::int64_t frame) {
    std::int64_t last = frame;
    if (const auto next = runs_.find(frame + 1); next != runs_.end()) {
        last = next->second;
        runs_.erase(next);
    }
    if (auto before = runs_.lower_bound(frame); before != runs_.begin()) {
        --before;
        if (before->second + 1 == frame) {
            before->second = last;
            return;
        }
    }
    runs_[frame] = last;
}

void FrameCache::takeFromRuns(std::int64_t frame) {
    const auto run = std::prev(runs_.upper_bound(frame));
    const std::int64_t first = run->first, last = run->second;
    runs_.erase(run);
    if (first < frame) runs_[first] = frame - 1;
    if (frame < last) runs_[frame + 1] = last;
}

void FrameCache::add(double seconds, std::shared_ptr<const HairPose> pose) {
    const std::int64_t frame = frameAt(range_.timeAt(static_cast<float>(seconds)));
    const std::size_t more = bytesOf(*pose);
    const std::lock_guard lock(mutex_);
    if (const auto there = frames_.find(frame); there != frames_.end()) remove(there);
    while (bytes_ + more > mostBytes_ && !frames_.empty()) remove(frames_.find(byAge_.begin()->second));
    if (more > mostBytes_) return;
    bytes_ += more;
    frames_[frame] = {std::move(pose), ++added_};
    byAge_[added_] = frame;
    addToRuns(frame);
}

std::shared_ptr<const HairPose> FrameCache::at(std::int64_t frame) const {
    const std::lock_guard lock(mutex_);
    const auto found = frames_.find(frame);
    return found == frames_.end() ? nullptr : found->second.pose;
}

std::vector<std::pair<std::int64_t, std::int64_t>> FrameCache::runs() const {
    const std::lock_guard lock(mutex_);
    return {runs_.begin(), runs_.end()};
}

}  // namespace hairloom::editor
