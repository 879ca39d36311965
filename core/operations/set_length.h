// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct SetLengthSettings {
    float length = 0.1f;
    float variation = 0;
    bool rescale = true;
    Vec3f gradientPoint = Vec3f::Zero();
    Vec3f gradientAxis = Vec3f(0, -1, 0);
    float gradientDistance = 0;
    float farScale = 1;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
std::span<const Field<SetLengthSettings>> fieldsOf(const SetLengthSettings&);

/// Gives strands this length with the number of points they have. Returns the number of strands touched.
Result<std::size_t> setLength(Groom& groom, const SetLengthSettings& settings, const Region& region = {});

}  // namespace hairloom
