// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How much of the material's dye hair has, point by point.

#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

namespace attribute {
/// Per point: float in [0, 1], as it was painted, in place of the strand's (core/groom/attributes.h).
inline constexpr std::string_view kPointDye = "dye";
}  // namespace attribute

/// The mask of each point, 0 … 1: the point attribute `dye`; without it the strand attribute `dye`; without
/// either 1 where the material has dye, for all hair is dyed then, and 0 where it has none.
std::vector<float> pointDyes(const Groom& groom);

}  // namespace hairloom
