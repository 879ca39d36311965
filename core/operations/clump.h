// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members. Level 1 is that of the largest clumps.
struct ClumpSettings {
    float spacing = 0.012f;
    float strength = 0.6f;
    float profile = 1.0f;
    float variation = 0.3f;
    float noise = 0;
    float noiseFrequency = 15;
    std::uint32_t levels = 1;
    float spacing2 = 0.005f;
    float strength2 = 0.6f;
    float noise2 = 0;
    float spacing3 = 0.002f;
    float strength3 = 0.6f;
    float noise3 = 0;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
std::span<const Field<ClumpSettings>> fieldsOf(const ClumpSettings&);

/// Pulls strands towards the nearest of some chosen among them, lengths kept, so that hair falls in locks.
/// With more levels strands gather in small clumps, which gather whole in larger ones. Frozen strands may be
/// chosen. Returns the number of strands touched.
Result<std::size_t> clump(Groom& groom, const ClumpSettings& settings, const Region& region = {});

}  // namespace hairloom
