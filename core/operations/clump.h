// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct ClumpSettings {
    float spacing = 0.012f;    ///< m; distance that chosen roots keep; larger locks are fewer
    float strength = 0.6f;     ///< share of the way to the chosen strand at the tip
    float profile = 1.0f;      ///< how the pull grows from the root: 1 evenly, above 1 nearer to the tip
    float variation = 0.3f;    ///< random share by which the pull of a strand may be weaker
    float clearance = 0.001f;  ///< m; distance kept from the skin
    std::uint64_t seed = 1;    ///< another seed chooses other strands
};
std::span<const Field<ClumpSettings>> fieldsOf(const ClumpSettings&);

/// Pulls strands towards the nearest of some chosen among them, lengths kept, so that hair falls in locks.
/// Frozen strands may be chosen. Returns the number of strands touched.
Result<std::size_t> clump(Groom& groom, const ClumpSettings& settings, const Region& region = {});

}  // namespace hairloom
