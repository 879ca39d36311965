// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The tables of light in fibres that runtime assets carry for the shaders of games.

#include <cstdint>
#include <vector>

#include "core/shading/marschner.h"

namespace hairloom::render {

/// HAIR_TABLE_FLOATS (runtime/shaders/hair_types.h) as 16-bit floats, of any absorption: that of `fibre` does
/// not count. On all cores, with the same bits for any number of them.
std::vector<std::uint16_t> gameFibreTables(const shading::MarschnerParameters& fibre);

}  // namespace hairloom::render
