// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct TrimSettings {
    Vec3f planePoint = Vec3f::Zero();   ///< metres; a point of the cutting plane
    Vec3f planeNormal = Vec3f::Zero();  ///< side that is cut away; zero: no plane
    float maxLength = 5.0f;             ///< metres; what is longer is cut
    float raggedness = 0;      ///< metres; each strand is cut shorter by a random length of up to this
    float minLength = 0.005f;  ///< metres that a cut always leaves
    std::uint64_t seed = 1;
};
std::span<const Field<TrimSettings>> fieldsOf(const TrimSettings&);

/// Cuts strands where they first cross the plane or reach the length; strands that do neither keep their
/// bits. A raggedness of 0 gives blunt ends. Returns the number of strands touched.
Result<std::size_t> trim(Groom& groom, const TrimSettings& settings, const Region& region = {});

}  // namespace hairloom
