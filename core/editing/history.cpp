// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/history.h"

#include <cassert>
#include <utility>

namespace hairloom::editing {

void History::add(std::unique_ptr<Command> command, std::string record) {
    dropUndone();
    entries_.push_back({std::move(command), std::move(record), ++lastState_});
    done_ = entries_.size();
    shrink();
}

Change History::undo(Model& model) {
    assert(canUndo());
    return entries_[--done_].command->exchange(model);
}

Change History::redo(Model& model) {
    assert(canRedo());
    return entries_[done_++].command->exchange(model);
}

void History::clear() {
    firstState_ = state();
    entries_.clear();
    done_ = 0;
}

std::size_t History::bytes() const {
    std::size_t sum = 0;
    for (const Entry& entry : entries_) sum += entry.command->bytes() + entry.record.size() + sizeof(Entry);
    return sum;
}

void History::setLimit(std::size_t bytes) {
    limit_ = bytes;
    shrink();
}

std::uint64_t History::state() const {
    return done_ == 0 ? firstState_ : entries_[done_ - 1].state;
}

void History::shrink() {
    std::size_t held = bytes();
    while (entries_.size() > 1 && done_ > 1 && held > limit_) {
        const Entry& oldest = entries_.front();
        held -= oldest.command->bytes() + oldest.record.size() + sizeof(Entry);
        firstState_ = oldest.state;
        entries_.pop_front();
        --done_;
        ++forgotten_;
    }
}

}  // namespace hairloom::editing
