// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace hairloom {

/// Whether a file's checksum is right. In programs for fuzzing every one is: what they change would otherwise
/// never come past it.
inline bool isChecksum(std::uint64_t computed, std::uint64_t stated) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    static_cast<void>(computed), static_cast<void>(stated);
    return true;
#else
    return computed == stated;
#endif
}

}  // namespace hairloom
