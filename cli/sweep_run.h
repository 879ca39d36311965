// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs parts of a sweep on this machine, each in a process of its own: what crashes costs its part.

#include <cstdint>

#include "cli/sweep_parts.h"

namespace hairloom::cli {

enum class SweepProgress : std::uint8_t {
    bar,     ///< on a terminal
    lines,   ///< on standard error, one every few seconds
    openjd,  ///< on standard output, as runners of Open Job Description read it
};

struct SweepCounts {
    std::size_t done = 0;  ///< in this run
    std::size_t kept = 0;  ///< that were done before
    std::size_t failed = 0;
    std::size_t elsewhere = 0;  ///< that another process does now
};

/// Does those of the parts that are not done yet, as many at a time as threadCount(). A part that fails holds
/// up no other. Errors: a folder that takes no files.
Result<SweepCounts> runParts(const SweepFolder& folder, const std::vector<std::size_t>& parts,
                             SweepProgress progress);

/// "3 min", for what is left of that many seconds
std::string durationText(double seconds);

}  // namespace hairloom::cli
