// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a thread has worked, whatever else the machine does.

#include <cstdint>

namespace hairloom {

/// Nanoseconds of processor time that this thread has had; on systems that tell it only in time slices, those
/// of a steady clock.
std::uint64_t threadNanoseconds();

}  // namespace hairloom
