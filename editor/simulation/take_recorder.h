// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Keeps what the player plays as a take, on a thread of its own.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/simulation/take_file.h"

namespace hairloom::editor {

class TakeRecorder {
  public:
    explicit TakeRecorder(TakeWriter writer);
    TakeRecorder(const TakeRecorder&) = delete;
    TakeRecorder& operator=(const TakeRecorder&) = delete;
    /// As finish().
    ~TakeRecorder();

    /// From any thread. Waits where frames come faster than they are written, so that none is lost. Nothing
    /// is taken once it has failed or is finished.
    void add(std::vector<Vec3f> positions_ws, HeadPose head);
    /// Writes what waits, and puts the take in its place. Errors: those of TakeWriter, also of frames before;
    /// whole blocks stay then.
    Status finish();

    std::uint64_t frames() const { return frames_; }
    std::uint64_t bytes() const { return bytes_; }
    bool hasFailed() const { return failed_; }

  private:
    struct Frame {
        std::vector<Vec3f> positions_ws;
        HeadPose head;
    };
    void run();

    TakeWriter writer_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Frame> waiting_;
    bool ends_ = false;
    Status status_;  ///< of the thread, for who has joined it
    std::atomic<std::uint64_t> frames_{0}, bytes_{0};
    std::atomic<bool> failed_{false};
    std::thread thread_;
};

}  // namespace hairloom::editor
