// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct CurlSettings {
    float radius = 0.006f;
    float frequency = 15.0f;
    float start = 0.03f;
    float phaseVariation = 1;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
std::span<const Field<CurlSettings>> fieldsOf(const CurlSettings&);

/// Winds one strand from the angle `phase` (radians) on; its root and its segments' `lengths` stay.
void curlStrand(std::span<Vec3f> points, std::span<const float> lengths, const CurlSettings& settings,
                float phase);

/// Winds strands into helices about their course, lengths kept, so that curled hair reaches less far. Returns
/// the number of strands touched.
Result<std::size_t> curl(Groom& groom, const CurlSettings& settings, const Region& region = {});

}  // namespace hairloom
