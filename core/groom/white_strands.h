// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which strands are white, and how much pigment the others have.

#include "core/groom/material.h"

namespace hairloom {

/// The most that the strand attribute `melanin` may have.
inline constexpr float kMostMelanin = 8;

/// Whether a strand is one of the share `greyShare` of white ones, by its root in the scalp's rest space
/// (metres). Each strand has a number of its own and is white where the share is above it: more grey turns
/// further strands white and no other back, and fewer hairs, in any order, keep theirs.
bool isWhite(const HairMaterial& material, const Vec3f& root_ss);

}  // namespace hairloom
