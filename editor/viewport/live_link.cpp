// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/live_link.h"

namespace hairloom::editor {

void LiveLink::add(Job job) {
    {
        const std::lock_guard lock(mutex_);
        if (!closed_) {
            jobs_.push_back(std::move(job));
            ++jobCount_;
            wake_();
            return;
        }
    }
    job(nullptr);
}

void LiveLink::run(LiveWork* work) {
    std::deque<Job> jobs;
    {
        const std::lock_guard lock(mutex_);
        jobs.swap(jobs_);
        jobCount_ = 0;
    }
    for (const Job& job : jobs) job(work);
}

void LiveLink::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        wake_ = [] {};
    }
    run(nullptr);
}

}  // namespace hairloom::editor
