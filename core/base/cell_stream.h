// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace hairloom {

/// A stream for Random of a cell of space, by its whole numbers. Cells 2²¹ apart share theirs.
inline std::uint64_t streamOf(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t stream = 0;
    for (const std::int64_t c : cell) stream = stream << 21u ^ (static_cast<std::uint64_t>(c) & 0x1fffffu);
    return stream;
}

}  // namespace hairloom
