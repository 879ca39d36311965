// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct NoiseSettings {
    float amplitude = 0.003f;  ///< m; how far waves lead aside at the tip
    float frequency = 20.0f;   ///< 1/m; waves for each metre of hair; segments limit it to one wave for four
    float rootShare = 0;       ///< amplitude at the root as a share of that at the tip
    float clearance = 0.001f;  ///< m; distance kept from the skin
    std::uint64_t seed = 1;    ///< another seed gives other waves
};
std::span<const Field<NoiseSettings>> fieldsOf(const NoiseSettings&);

/// Bends each strand by smooth random waves of its own, lengths kept: frizz with short waves, an uneven fall
/// with long ones. Returns the number of strands touched.
Result<std::size_t> noise(Groom& groom, const NoiseSettings& settings, const Region& region = {});

}  // namespace hairloom
