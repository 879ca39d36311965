// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is painted on a hairstyle, as masks and formulas read it.

#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

enum class MaskMap : std::uint32_t { none, density, dye, mask1, mask2, mask3, mask4 };

/// One value for each point, 0 … 1. `none` is 1 everywhere; density is 0 where hair is bound to no scalp.
std::vector<float> paintedValues(const Groom& groom, MaskMap map);
/// Differs where what is painted differs.
std::string paintedState(const Groom& groom, MaskMap map);

}  // namespace hairloom
