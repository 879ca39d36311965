// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/take_recorder.h"

#include <utility>

namespace hairloom::editor {
namespace {

constexpr std::size_t kMostWaiting = 8;  ///< frames

}  // namespace

TakeRecorder::TakeRecorder(TakeWriter writer) : writer_(std::move(writer)), thread_([this] { run(); }) {}

TakeRecorder::~TakeRecorder() {
    static_cast<void>(finish());
}

void TakeRecorder::add(std::vector<Vec3f> positions_ws, HeadPose head) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kMostWaiting || ends_ || failed_; });
    if (ends_ || failed_) return;
    waiting_.push_back({std::move(positions_ws), std::move(head)});
    changed_.notify_all();
}

void TakeRecorder::run() {
    while (true) {
        Frame frame;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return !waiting_.empty() || ends_; });
            if (waiting_.empty()) return;
            frame = std::move(waiting_.front());
            waiting_.pop_front();
        }
        changed_.notify_all();
        if (status_) status_ = writer_.add(frame.positions_ws, inWorld(std::move(frame.head)));
        frames_ = writer_.frames();
        bytes_ = writer_.bytes();
        if (status_) continue;
        failed_ = true;
        changed_.notify_all();
    }
}

Status TakeRecorder::finish() {
    {
        const std::lock_guard lock(mutex_);
        if (ends_) return status_;
        ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
    // A frame that cannot be kept ends a take, and the frames before it are one.
    auto finished = writer_.finish();
    if (status_) status_ = std::move(finished);
    bytes_ = writer_.bytes();
    return status_;
}

}  // namespace hairloom::editor
