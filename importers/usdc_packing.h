// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How binary USD packs bytes and whole numbers (OpenUSD's pxr/base/tf/fastCompression and
// pxr/usd/sdf/integerCoding).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// Blocks of LZ4, one or several, into at most `size` bytes. Errors, without a file: bytes that are no such
/// blocks, more bytes than that.
Result<std::vector<std::byte>> unpackBytes(std::span<const std::byte> packed, std::uint64_t size);

/// `count` numbers, each as its difference to the one before it. The packed bytes bear out the count before
/// anything is allocated.
Result<std::vector<std::int32_t>> unpackIntegers32(std::span<const std::byte> packed, std::uint64_t count);
Result<std::vector<std::int64_t>> unpackIntegers64(std::span<const std::byte> packed, std::uint64_t count);

}  // namespace hairloom
