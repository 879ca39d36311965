// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How much memory a program takes.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hairloom::benchmarks {

/// Runs a program (`command`: its path and arguments) to its end, silently. The most memory that it had at
/// once, in bytes; nothing where it cannot run, fails, or the system does not tell (only Linux does).
std::optional<std::uint64_t> peakMemory(std::vector<std::string> command);

}  // namespace hairloom::benchmarks
