// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct ClumpSettings {
    float spacing = 0.012f;
    float strength = 0.6f;
    float profile = 1.0f;
    float variation = 0.3f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
std::span<const Field<ClumpSettings>> fieldsOf(const ClumpSettings&);

/// Pulls strands towards the nearest of some chosen among them, lengths kept, so that hair falls in locks.
/// Frozen strands may be chosen. Returns the number of strands touched.
Result<std::size_t> clump(Groom& groom, const ClumpSettings& settings, const Region& region = {});

}  // namespace hairloom
