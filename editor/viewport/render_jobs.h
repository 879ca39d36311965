// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the thread that plays to the render thread, which owns the device: jobs that are done between
// pictures, in the order in which they were given.

#include <atomic>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <type_traits>

#include "editor/viewport/played_hair.h"

namespace hairloom::editor {

class RenderJobs {
  public:
    /// The result of `job`, which is called with null once there is no device.
    template <class Job>
    auto post(Job job) {
        using Value = std::invoke_result_t<Job, PlayedHair*>;
        auto task = std::make_shared<std::packaged_task<Value(PlayedHair*)>>(std::move(job));
        auto value = task->get_future();
        add([task](PlayedHair* played) { (*task)(played); });
        return value;
    }

    /// Whether marks show where strands are: frames tell it then.
    bool wantsPositions() const { return wantsPositions_; }
    void setWantsPositions(bool on) { wantsPositions_ = on; }

    // For the render thread.
    /// `wake` is called, on any thread, when there is a job.
    explicit RenderJobs(std::function<void()> wake) : wake_(std::move(wake)) {}
    bool hasJobs() const { return jobCount_ > 0; }
    /// What is there now: where steps take longer than they last the next is always there, and pictures wait.
    void run(PlayedHair* played);
    /// From now on jobs are called at once, with null.
    void close();

  private:
    using Job = std::function<void(PlayedHair*)>;
    void add(Job job);

    mutable std::mutex mutex_;
    std::function<void()> wake_;
    std::deque<Job> jobs_;
    bool closed_ = false;
    std::atomic<bool> wantsPositions_ = false;
    std::atomic<std::size_t> jobCount_ = 0;  ///< told without the lock, which add() holds while it wakes
};

}  // namespace hairloom::editor
