// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace hairloom {

/// The engine's vector code held to one instruction set while it lives, for the whole program. One at
/// a time, and not while another thread runs the engine.
class InstructionSetLimit {
  public:
    /// `target` is one of available().
    explicit InstructionSetLimit(std::int64_t target);
    ~InstructionSetLimit();
    InstructionSetLimit(const InstructionSetLimit&) = delete;
    InstructionSetLimit& operator=(const InstructionSetLimit&) = delete;

    /// Highway's numbers of those that this machine has, the best first. Not while one is held.
    static std::vector<std::int64_t> available();
};

}  // namespace hairloom
