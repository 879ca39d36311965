// SPDX-License-Identifier: MIT
#pragma once
// The arrays of a body as bits: what the neighbours of a number do not tell already.

#include <cstdint>
#include <span>
#include <vector>

#include "hairloom/body_field.h"

namespace hairloom::runtime {

/// Corners, and no more blocks than indices tell apart: what a packed body may unpack to, however few its
/// bytes.
inline constexpr std::uint64_t kMostPackedCorners = 1u << 22u;

/// Distances, skins, blocks and their values.
std::vector<std::uint8_t> packBodyNumbers(const BodyField& field);
/// Back into a field whose `size` is known. False where it is too large, or where bits are missing or left
/// over; nothing is allocated for a size that these bytes cannot have.
bool unpackBodyNumbers(std::span<const std::uint8_t> bytes, std::uint32_t blocks, BodyField& field);

}  // namespace hairloom::runtime
