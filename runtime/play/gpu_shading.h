// SPDX-License-Identifier: MIT
#pragma once
// What the passes that light and shade hairs are given: materials, tables, streaks.

#include "hairloom/asset.h"
#include "shaders/hair_types.h"

namespace hairloom::runtime {

/// Columns of a lamp's grid, and its numbers: where hair begins in each, and its slices.
inline constexpr std::size_t kLampColumns = std::size_t{HAIR_COLUMNS} * HAIR_COLUMNS,
                             kLampCells = kLampColumns * (HAIR_SLICES + 1);

/// Whether fillShading() fills the buffer.
bool fillsShading(std::uint32_t buffer);
/// The whole buffer, of hairs in `order`.
void fillShading(const Asset& asset, std::uint32_t buffer, std::span<const std::uint32_t> order, void* out);

}  // namespace hairloom::runtime
