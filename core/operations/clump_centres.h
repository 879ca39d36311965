// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which strands lead locks.

#include <cstdint>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

/// For each strand the nearest chosen strand by root. Strands are chosen in random order wherever no chosen
/// root is nearer than `spacing` metres (> 0); a chosen strand names itself. Strands of fewer than 2 points
/// name themselves and are never chosen for others.
std::vector<std::uint32_t> chooseCentres(const Groom& groom, float spacing, std::uint64_t seed);

}  // namespace hairloom
