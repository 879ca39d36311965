// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct SmoothSettings {
    float amount = 0.5f;       ///< share of the way to the middle of the neighbours in each pass
    std::uint32_t passes = 5;  ///< more is smoother over longer stretches
    float clearance = 0.001f;  ///< m; distance kept from the skin
};
std::span<const Field<SmoothSettings>> fieldsOf(const SmoothSettings&);

/// Takes bends out of strands, lengths kept. Returns the number of strands touched.
Result<std::size_t> smooth(Groom& groom, const SmoothSettings& settings, const Region& region = {});

}  // namespace hairloom
