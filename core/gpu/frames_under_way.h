// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Frames that wait on the device while the next ones are recorded: enough that it never waits, few enough
// that their command memory stays small.

#include <deque>
#include <functional>

#include "core/gpu/device.h"

namespace hairloom::gpu {

class FramesUnderWay {
  public:
    /// `finished` is called with the times of each frame, in the order of their submission.
    FramesUnderWay(std::size_t most, std::function<void(const std::vector<PassTime>&)> finished)
        : most_(most), finished_(std::move(finished)) {}

    /// Waits where there are more than `most`. Errors: those of Submission::passTimes().
    Status add(SubmissionPtr submission) {
        frames_.push_back(std::move(submission));
        return finish(most_);
    }
    /// Waits for all.
    Status finish() { return finish(0); }

  private:
    Status finish(std::size_t left) {
        for (; frames_.size() > left; frames_.pop_front()) {
            const auto times = frames_.front()->passTimes();
            if (!times) return tl::unexpected(times.error());
            finished_(*times);
        }
        return {};
    }

    std::size_t most_;
    std::function<void(const std::vector<PassTime>&)> finished_;
    std::deque<SubmissionPtr> frames_;
};

}  // namespace hairloom::gpu
