// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct SmoothSettings {
    float amount = 0.5f;
    std::uint32_t passes = 5;
    float clearance = 0.001f;
};
std::span<const Field<SmoothSettings>> fieldsOf(const SmoothSettings&);

/// Takes bends out of strands, lengths kept. Returns the number of strands touched.
Result<std::size_t> smooth(Groom& groom, const SmoothSettings& settings, const Region& region = {});

}  // namespace hairloom
