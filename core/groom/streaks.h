// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which strands are in streaks.

#include <span>
#include <vector>

#include "core/groom/material.h"

namespace hairloom {

/// How much each strand is in a streak, 0…1, by its root in the scalp's rest space (metres). Streaks are
/// cells of `streakWidth` around points that lie at random, one in a cube, so that roots beside each other
/// are in the same; a share `streakShare` of the cells are streaks. Softness fades the border over that part
/// of half the width. The same for any order of roots. Empty where the material has no streaks.
std::vector<float> streakWeights(const HairMaterial& material, std::span<const Vec3f> roots_ss);

}  // namespace hairloom
