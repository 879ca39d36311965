// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What has played, frame by frame in memory, so that the play head goes back to it. Safe on any threads.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/groom/time_line.h"
#include "editor/viewport/picture_request.h"

namespace hairloom::editor {

class FrameCache {
  public:
    /// Beyond so many bytes the frames that were added first go.
    static constexpr std::size_t kMostBytes = std::size_t{512} << 20u;

    /// Frames are counted on `line`, of which the range, the loop and the frame rate matter.
    explicit FrameCache(const TimeLine& line, std::size_t mostBytes = kMostBytes);

    /// `seconds` behind the start of the motion; in place of what played there before.
    void add(double seconds, std::shared_ptr<const HairPose> pose);
    /// Null where nothing is kept.
    std::shared_ptr<const HairPose> at(std::int64_t frame) const;
    std::int64_t frameAt(float lineTime) const;
    float framesPerSecond() const { return range_.framesPerSecond; }
    /// First and last frame of those that follow each other; kept up to date, since each paint asks.
    std::vector<std::pair<std::int64_t, std::int64_t>> runs() const;

  private:
    struct Kept {
        std::shared_ptr<const HairPose> pose;
        std::uint64_t age = 0;  ///< number of the call that added it
    };
    using Frames = std::map<std::int64_t, Kept>;
    void remove(Frames::iterator frame);
    void addToRuns(std::int64_t frame);
    void takeFromRuns(std::int64_t frame);

    TimeLine range_;
    std::size_t mostBytes_;
    mutable std::mutex mutex_;
    Frames frames_;
    std::map<std::int64_t, std::int64_t> runs_;  ///< last frame of each by its first
    std::map<std::uint64_t, std::int64_t> byAge_;
    std::size_t bytes_ = 0;
    std::uint64_t added_ = 0;
};

}  // namespace hairloom::editor
