// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "core/groom/groom.h"

namespace hairloom {

/// Gives the strands these points, of one strand after the other, as many as they have.
void moveStrands(Groom& groom, std::span<const std::uint32_t> strands, std::span<const Vec3f> points);

}  // namespace hairloom
