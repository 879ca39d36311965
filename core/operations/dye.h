// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct DyeSettings {
    float amount = 1;              ///< 0 … 1; what the mask becomes
    Vec3f centre = Vec3f::Zero();  ///< metres, in the scalp's rest space
    float radius = 0;              ///< metres around the centre that roots are reached in; 0: all
    float softness = 0.01f;        ///< metres over which the reach fades at the ball's rim
    float variation = 0;           ///< 0 … 1; random share by which a strand's amount may be lower
    std::uint64_t seed = 1;
};
std::span<const Field<DyeSettings>> fieldsOf(const DyeSettings&);

/// Sets the strand attribute `dye`, which says how much of the material's dye a strand has, or the point
/// attribute where hair was painted. Strands that the region does not reach keep what they have, or 0.
/// Returns the number of strands whose amount changed.
Result<std::size_t> dye(Groom& groom, const DyeSettings& settings, const Region& region = {});

}  // namespace hairloom
