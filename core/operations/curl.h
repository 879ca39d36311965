// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct CurlSettings {
    float radius = 0.006f;     ///< m; of the helix
    float frequency = 15.0f;   ///< 1/m; turns for each metre of hair; segments limit it to one turn for four
    float start = 0.03f;       ///< m; way from the root over which the radius grows to its full size
    float phaseVariation = 1;  ///< 1 starts each strand at any angle, 0 all at the same
    float clearance = 0.001f;  ///< m; distance kept from the skin
    std::uint64_t seed = 1;    ///< another seed gives other angles
};
std::span<const Field<CurlSettings>> fieldsOf(const CurlSettings&);

/// Winds strands into helices about their course, lengths kept, so that curled hair reaches less far. Returns
/// the number of strands touched.
Result<std::size_t> curl(Groom& groom, const CurlSettings& settings, const Region& region = {});

}  // namespace hairloom
