// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A block of parallel strands, for continua of hair.

#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "hairloom/math.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// `across`² strands of `points` points that hang along −y, all `spacing` metres from their neighbours.
struct HairBlock {
    std::uint32_t across = 0, points = 0;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions;

    StrandsView view() const { return {offsets, positions}; }
    std::size_t at(std::uint32_t x, std::uint32_t z, std::uint32_t p) const {
        return (std::size_t{z} * across + x) * points + p;
    }
    std::size_t middle() const { return at(across / 2, across / 2, points / 2); }
};

inline HairBlock blockOfHair(std::uint32_t across, std::uint32_t points, float spacing) {
    HairBlock hair;
    hair.across = across;
    hair.points = points;
    const float half = 0.5f * static_cast<float>(across - 1);
    for (std::uint32_t s = 0; s < across * across; ++s) {
        for (std::uint32_t p = 0; p < points; ++p)
            hair.positions.push_back(Float3{static_cast<float>(s % across) - half, -static_cast<float>(p),
                                            static_cast<float>(s / across) - half} *
                                     spacing);
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions.size()));
    }
    return hair;
}

/// Each off by up to `size` along each axis.
inline std::vector<Float3> shaken(std::vector<Float3> points, float size, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return (static_cast<float>(random()) * 0x1p-31f - 1.0f) * size; };
    for (Float3& p : points) {
        const float x = uniform(), y = uniform(), z = uniform();
        p = p + Float3{x, y, z};
    }
    return points;
}

inline std::array<double, 3> momentumOf(std::span<const Float3> velocities, std::span<const float> masses) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        const double mass = static_cast<double>(masses[i]);
        sum[0] += mass * static_cast<double>(velocities[i].x);
        sum[1] += mass * static_cast<double>(velocities[i].y);
        sum[2] += mass * static_cast<double>(velocities[i].z);
    }
    return sum;
}

}  // namespace hairloom::runtime
