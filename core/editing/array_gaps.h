// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Gaps that open or close in an array, in place and on several threads.

#include <cstddef>
#include <span>

namespace hairloom::editing {

/// [begin, begin + count) of an array.
struct Range {
    std::size_t begin;
    std::size_t count;
};

std::size_t total(std::span<const Range> ranges);

/// Moves what lies in `bytes` between and behind the gaps to where it is once they are closed. `gaps` ascend,
/// part from each other, and count elements of `size` bytes; what the last total(gaps) elements hold
/// afterwards is of no use.
void closeGaps(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps);
/// The inverse: before, the last total(gaps) elements hold nothing of use, afterwards the gaps.
void openGaps(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps);

}  // namespace hairloom::editing
