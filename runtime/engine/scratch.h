// SPDX-License-Identifier: MIT
#pragma once
// What threads work in while they run blocks, so that a step needs little stack. It belongs to an engine: as
// many pieces as threads can run at a time, as large as the plan's solvers need for the longest strand.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/state.h"

namespace hairloom::runtime {

class Scratch {
  public:
    struct Piece : InMemory {
        LaneFrame lanes;  ///< lanes.own and lanes.solver are memory
        Floats memory;
        std::atomic<bool> taken = false;
    };

    Scratch() = default;
    /// A copy has pieces of its own.
    Scratch(const Scratch& other) { make(other.count_, other.own_, other.floats_); }
    Scratch& operator=(const Scratch& other) {
        make(other.count_, other.own_, other.floats_);
        return *this;
    }

    /// Has `count` pieces with `own` floats for LaneFrame::own and at least `floats` for its solver each.
    /// Only while none is taken.
    void grow(std::size_t count, std::size_t own, std::size_t floats);
    /// LaneFrame::touchable and touchableCapsules of each piece can take so many without asking for memory.
    void reserveSpheres(std::size_t count, std::size_t capsules);
    /// A free piece, the calling thread's own where it can be: its memory is then in that core's cache. Waits
    /// where all are taken. The caller gives it back: `taken = false`.
    Piece& take();
    std::size_t bytes() const;

  private:
    void make(std::size_t count, std::size_t own, std::size_t floats);

    std::unique_ptr<Piece[]> pieces_;
    std::size_t count_ = 0, own_ = 0, floats_ = 0;
};

/// As many pieces as threads of this machine can take for `jobs` jobs.
std::size_t scratchPieces(std::size_t jobs);

}  // namespace hairloom::runtime
