// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is painted on a hairstyle, as masks and formulas read it.

#include <string>
#include <string_view>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

enum class MaskMap : std::uint32_t { none, density, dye, mask1, mask2, mask3, mask4 };

/// The name that it was given, else "Mask 1". `number` counts from 1.
std::string maskName(const Groom& groom, std::uint32_t number);
/// The number of the mask with that name, or of "mask 1" and "1". Error: there is none, listing those there
/// are.
Result<std::uint32_t> findMask(const Groom& groom, std::string_view name);
/// The groom's names after that of one changed: without spaces around it, and as maskNames has them. Empty:
/// it has none again. Errors: a name of more than kLongestMaskName bytes or with control characters, one that
/// reads as a number or that another mask has.
Result<std::vector<std::string>> maskNamesWith(const Groom& groom, std::uint32_t number,
                                               std::string_view name);

/// One value for each point, 0 … 1. `none` is 1 everywhere; density is 0 where hair is bound to no scalp.
std::vector<float> paintedValues(const Groom& groom, MaskMap map);
/// Differs where what is painted differs.
std::string paintedState(const Groom& groom, MaskMap map);

}  // namespace hairloom
