// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct NoiseSettings {
    float amplitude = 0.003f;
    float frequency = 20.0f;
    float rootShare = 0;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
std::span<const Field<NoiseSettings>> fieldsOf(const NoiseSettings&);

/// Bends one strand by the waves of `stream`; its root and its segments' `lengths` stay.
void noiseStrand(std::span<Vec3f> points, std::span<const float> lengths, const NoiseSettings& settings,
                 std::uint64_t stream);

/// Bends each strand by smooth random waves of its own, lengths kept: frizz with short waves, an uneven fall
/// with long ones. Returns the number of strands touched.
Result<std::size_t> noise(Groom& groom, const NoiseSettings& settings, const Region& region = {});

}  // namespace hairloom
