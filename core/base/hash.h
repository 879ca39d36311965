// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// XXH3 hashes, equal on every platform of the same byte order. Not for security.

#include <cstddef>
#include <cstdint>
#include <span>

namespace hairloom {

std::uint64_t hashBytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

/// Hash of the object representation; for types without padding.
template <class T>
std::uint64_t hashOf(std::span<const T> values, std::uint64_t seed = 0) {
    return hashBytes(std::as_bytes(values), seed);
}

}  // namespace hairloom
