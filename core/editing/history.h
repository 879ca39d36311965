// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What was done, in order, within a bound of memory.

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "core/editing/command.h"

namespace hairloom::editing {

class History {
  public:
    static constexpr std::size_t kDefaultLimit = std::size_t{512} << 20u;

    /// Adds a command that has been carried out, with its record as a script's operation (JSON, as
    /// Command::record()). What was undone is forgotten. The oldest steps go while more than the limit is
    /// held, but the newest stays whatever its size.
    void add(std::unique_ptr<Command> command, std::string record = {});
    bool canUndo() const { return done_ > 0; }
    bool canRedo() const { return done_ < entries_.size(); }
    /// Only when it can.
    Change undo(Model& model);
    Change redo(Model& model);
    /// Forgets what was undone.
    void dropUndone() { entries_.resize(done_); }
    void clear();

    std::size_t size() const { return entries_.size(); }
    std::size_t doneCount() const { return done_; }
    std::string name(std::size_t index) const { return entries_[index].command->name(); }
    const std::string& record(std::size_t index) const { return entries_[index].record; }

    std::size_t bytes() const;
    std::size_t limit() const { return limit_; }
    void setLimit(std::size_t bytes);
    /// Steps that the limit has made it forget.
    std::size_t forgotten() const { return forgotten_; }
    /// A number that tells the states reached by these steps apart; 0 before the first.
    std::uint64_t state() const;

  private:
    struct Entry {
        std::unique_ptr<Command> command;
        std::string record;
        std::uint64_t state;
    };
    void shrink();

    std::deque<Entry> entries_;
    std::size_t done_ = 0;
    std::size_t limit_ = kDefaultLimit;
    std::size_t forgotten_ = 0;
    std::uint64_t lastState_ = 0;
    std::uint64_t firstState_ = 0;  ///< before the oldest entry
};

}  // namespace hairloom::editing
