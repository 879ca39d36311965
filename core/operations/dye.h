// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct DyeSettings {
    float amount = 1;
    Vec3f centre = Vec3f::Zero();
    float radius = 0;
    float softness = 0.01f;
    float variation = 0;
    std::uint64_t seed = 1;
};
std::span<const Field<DyeSettings>> fieldsOf(const DyeSettings&);

/// Sets the strand attribute `dye`, which says how much of the material's dye a strand has, or the point
/// attribute where hair was painted. Strands that the region does not reach keep what they have, or 0.
/// Returns the number of strands whose amount changed.
Result<std::size_t> dye(Groom& groom, const DyeSettings& settings, const Region& region = {});

}  // namespace hairloom
