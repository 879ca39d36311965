// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Names of temporary files that go when a signal ends the process.

#include <array>
#include <atomic>
#include <cstddef>
#include <string>

namespace hairloom {

/// A name that the signals' handler takes away. It is written before its file is made and cleared after it is
/// gone: removing a name that is not there does no harm.
struct EndedSlot {
    std::atomic<int> state{0};  ///< 0 free, 1 being written, 2 in use
    int folder = -1;
    std::array<char, 256> name{};
};
/// None where all are in use; then a killed run leaves the file for findLeftOvers().
EndedSlot* takeEndedSlot(int folder, const std::string& name);
/// Whether the name is in a slot.
bool isInEndedSlot(const std::string& name);

}  // namespace hairloom
