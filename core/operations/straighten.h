// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Waves and curls taken out of a strand; its fall over the head stays.

#include <span>

#include "core/base/math.h"

namespace hairloom {

/// Turns each segment by the share `amount` (0 … 1) to where the strand leads over a piece `over` (metres)
/// around it; 0 makes a line of the whole strand. Root and segments' `lengths` stay.
void straightenStrand(std::span<Vec3f> points, std::span<const float> lengths, float over, float amount);

}  // namespace hairloom
