// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Values of strands that come from images, painted masks and other attributes: the mask of the dye (strand
// attribute `dye`), in place of what was painted; the melanin (`melanin`); and the stiffness (`stiffness`).

#include <span>
#include <string>
#include <vector>

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

/// What black and white stand for, each times the stiffness of the settings, 0 … runtime::kMostStiffness.
struct StiffnessRange {
    float black = 0;
    float white = 1;
};
/// Of shares 0 … 1, one for each strand.
std::vector<float> stiffnessOfShares(std::span<const float> shares, const StiffnessRange& range);
/// As dyeFromImage().
Status stiffnessFromImage(const std::string& path, const StiffnessRange& range, Groom& groom);
/// A painted mask by its name or number, as findMask(). Error: none of that name, or nothing is painted.
Status stiffnessFromMask(const std::string& name, const StiffnessRange& range, Groom& groom);
/// As melaninFromAttribute(), clamped to 0 … runtime::kMostStiffness.
Status stiffnessFromAttribute(const std::string& name, Groom& groom);

}  // namespace hairloom
