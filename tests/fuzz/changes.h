// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Inputs that are changes of a sample: a place of three bytes, then the byte that stands there.

#include <cstddef>
#include <cstdint>
#include <span>

namespace hairloom {

inline void change(std::span<std::byte> bytes, std::span<const std::uint8_t> changes) {
    for (; changes.size() >= 4 && !bytes.empty(); changes = changes.subspan(4)) {
        const std::size_t at =
            std::size_t{changes[0]} | std::size_t{changes[1]} << 8u | std::size_t{changes[2]} << 16u;
        bytes[at % bytes.size()] = static_cast<std::byte>(changes[3]);
    }
}

}  // namespace hairloom
