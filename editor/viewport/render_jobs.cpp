// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/render_jobs.h"

namespace hairloom::editor {

void RenderJobs::add(Job job) {
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

void RenderJobs::run(PlayedHair* played) {
    std::deque<Job> jobs;
    {
        const std::lock_guard lock(mutex_);
        jobs.swap(jobs_);
        jobCount_ = 0;
    }
    for (const Job& job : jobs) job(played);
}

void RenderJobs::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        wake_ = [] {};
    }
    run(nullptr);
}

}  // namespace hairloom::editor
