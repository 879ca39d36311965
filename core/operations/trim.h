// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct TrimSettings {
    Vec3f planePoint = Vec3f::Zero();
    Vec3f planeNormal = Vec3f::Zero();
    float maxLength = 5.0f;
    float raggedness = 0;
    float minLength = 0.005f;
    std::uint64_t seed = 1;
};
std::span<const Field<TrimSettings>> fieldsOf(const TrimSettings&);

/// Cuts strands where they first cross the plane or reach the length; strands that do neither keep their
/// bits. A raggedness of 0 gives blunt ends. Returns the number of strands touched.
Result<std::size_t> trim(Groom& groom, const TrimSettings& settings, const Region& region = {});

}  // namespace hairloom
