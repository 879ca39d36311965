// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The strand in the middle of those that a dab reaches: what brushes twist hair about and gather it to.

#include <vector>

#include "core/editing/brush.h"

namespace hairloom::editing {

/// The mean of the strands by their greatest weights, as 16 points from root to tip; of thousands of strands
/// a few hundred stand for all. Empty where nothing is reached.
std::vector<Vec3f> middleStrand(const Groom& groom, const Reached& reached);

}  // namespace hairloom::editing
