// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where the mask of the dye (strand attribute `dye`) comes from, beside the script operation and the brush,
// whose mask it replaces, and the melanin of strands (strand attribute `melanin`).

#include <string>

#include "core/groom/groom.h"

namespace hairloom {

/// A MaskImage's value at each strand's root UV. Error: no PNG, or strands without root UVs.
Status dyeFromImage(const std::string& path, Groom& groom);
/// A strand attribute of numbers or flags, clamped to 0…1. Error: no such attribute, or one of another type.
Status dyeFromAttribute(const std::string& name, Groom& groom);

/// As dyeFromImage(): white strands keep the melanin of their material, black ones have none.
Status melaninFromImage(const std::string& path, Groom& groom);
/// A strand attribute of numbers, clamped to 0 … kMostMelanin, each times the material's melanin.
Status melaninFromAttribute(const std::string& name, Groom& groom);

}  // namespace hairloom
