// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct ResampleSettings {
    std::uint32_t points = 16;
};
std::span<const Field<ResampleSettings>> fieldsOf(const ResampleSettings&);

/// Gives strands this number of points, evenly spaced by arc length; what points carry is interpolated. The
/// shape as it is becomes all there is: operators go. Returns the number of strands touched.
Result<std::size_t> resample(Groom& groom, const ResampleSettings& settings, const Region& region = {});

}  // namespace hairloom
