// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct SetLengthSettings {
    float length = 0.1f;  ///< metres; length of strands before variation and gradient
    float variation = 0;  ///< 0 … 1; each strand is shortened by a random share of up to this
    bool rescale = true;  ///< true: the shape is scaled; false: strands are cut, or go on straight
    Vec3f gradientPoint = Vec3f::Zero();   ///< metres; where the gradient begins
    Vec3f gradientAxis = Vec3f(0, -1, 0);  ///< direction in which lengths change
    float gradientDistance = 0;  ///< metres along the axis until farScale is reached; 0: no gradient
    float farScale = 1;          ///< length at the gradient's end over that at its beginning
    float clearance = 0.001f;    ///< metres kept from the skin
    std::uint64_t seed = 1;
};
std::span<const Field<SetLengthSettings>> fieldsOf(const SetLengthSettings&);

/// Gives strands this length with the number of points they have. Returns the number of strands touched.
Result<std::size_t> setLength(Groom& groom, const SetLengthSettings& settings, const Region& region = {});

}  // namespace hairloom
