// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Direct solves on the length constraints c_s = ½(|e_s|²/l_s − l_s) of one strand; clamped points have
// infinite mass, and segments between clamped points no constraint.

#include "core/simulation/reference/strand.h"

namespace hairloom::reference {

/// Largest ||e|/l − 1| of a segment with a free point.
double largestStretch(const StrandShape& shape, const std::vector<Vec3d>& x);

/// Moves free points until the lengths hold to rounding, along the gradients and weighted by mass. False when
/// 50 Newton steps do not bring them there.
bool projectLengths(const StrandShape& shape, std::vector<Vec3d>& x);

/// Takes from v what changes a length, weighted by mass.
void projectVelocities(const StrandShape& shape, const std::vector<Vec3d>& x, std::vector<Vec3d>& v);

}  // namespace hairloom::reference
