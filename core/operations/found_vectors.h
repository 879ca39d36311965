// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What operators take where a point or a direction is zero, so that people see a place on the head and no
// zeros.

#include <optional>

#include "core/operations/stack.h"

namespace hairloom {

/// Of a vector of the operator that is zero and stands for a place that the operator finds on this head, or
/// for any place of a plane: that place, metres in the scalp's rest space, or the direction, of length 1.
/// Naming it changes nothing of what the operator does. Nothing where the vector is not zero, where zero is
/// meant (no sweep, no plane), and without a scalp.
std::optional<Vec3f> vectorFound(const Groom& groom, const Operator& one, const FieldInfo& field,
                                 SettingsPart part = SettingsPart::own);

}  // namespace hairloom
