// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf().
struct DrapeSettings {
    float amount = 0.5f;       ///< share of the turn towards straight down at the tip
    float rootAmount = 0;      ///< share of the turn at the root; between, it changes evenly
    float clearance = 0.001f;  ///< m; distance kept from the skin
};
std::span<const Field<DrapeSettings>> fieldsOf(const DrapeSettings&);

/// Bends strands towards −Y as gravity does, lengths kept. Returns the number of strands touched.
Result<std::size_t> drape(Groom& groom, const DrapeSettings& settings, const Region& region = {});

}  // namespace hairloom
