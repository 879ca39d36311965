// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct DrapeSettings {
    float amount = 0.5f;
    float rootAmount = 0;
    float clearance = 0.001f;
};
std::span<const Field<DrapeSettings>> fieldsOf(const DrapeSettings&);

/// Bends strands towards −Y as gravity does, lengths kept. Returns the number of strands touched.
Result<std::size_t> drape(Groom& groom, const DrapeSettings& settings, const Region& region = {});

}  // namespace hairloom
