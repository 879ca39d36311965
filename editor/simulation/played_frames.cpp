// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/played_frames.h"

#include <cmath>

namespace hairloom::editor {
namespace {

std::size_t bytesOf(const HairPose& pose) {
    return (pose.positions_ws.size() + pose.velocities_ws.size() + pose.head.scalpPositions_ws.size()) *
           sizeof(Vec3f);
}

}  // namespace

PlayedFrames::PlayedFrames(const TimeLine& line) {
    range_.framesPerSecond = line.framesPerSecond;
    range_.start = line.start;
    range_.end = line.end;
    range_.loop = line.loop;
}

std::int64_t PlayedFrames::frameAt(float lineTime) const {
    return std::llround(static_cast<double>(lineTime) * static_cast<double>(range_.framesPerSecond));
}

void PlayedFrames::add(double seconds, std::shared_ptr<const HairPose> pose) {
    const std::int64_t frame = frameAt(range_.timeAt(static_cast<float>(seconds)));
    const std::size_t more = bytesOf(*pose);
    const std::lock_guard lock(mutex_);
    const auto there = frames_.find(frame);
    const std::size_t less = there == frames_.end() ? 0 : bytesOf(*there->second);
    if (bytes_ - less + more > kMostBytes) return;
    bytes_ += more - less;
    frames_[frame] = std::move(pose);
}

std::shared_ptr<const HairPose> PlayedFrames::at(std::int64_t frame) const {
    const std::lock_guard lock(mutex_);
    const auto found = frames_.find(frame);
    return found == frames_.end() ? nullptr : found->second;
}

std::vector<std::pair<std::int64_t, std::int64_t>> PlayedFrames::runs() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<std::int64_t, std::int64_t>> runs;
    for (const auto& [frame, pose] : frames_) {
        if (!runs.empty() && runs.back().second + 1 == frame)
            runs.back().second = frame;
        else
            runs.emplace_back(frame, frame);
    }
    return runs;
}

}  // namespace hairloom::editor
