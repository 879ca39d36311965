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
    while (true) {
        Job job;
        {
            const std::lock_guard lock(mutex_);
            if (jobs_.empty()) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
            --jobCount_;
        }
        job(work);
    }
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
