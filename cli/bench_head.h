// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The ellipsoid that hair of benchmarks grows on.

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/math.h"

namespace hairloom::cli {

/// A place on an ellipsoid of the size of a head around the origin, grown by a factor; angles in radians from
/// its crown and about the vertical.
inline Vec3f onBenchHead(float size, float down, float around) {
    return {size * 0.075f * std::sin(down) * std::cos(around), size * 0.11f * std::cos(down),
            size * 0.095f * std::sin(down) * std::sin(around)};
}

/// Its skin: triangles, counter-clockwise from outside.
struct BenchHead {
    std::vector<Vec3f> points;
    std::vector<std::uint32_t> indices;

    explicit BenchHead(std::uint32_t sectors) {
        constexpr std::uint32_t kRings = 48;
        for (std::uint32_t r = 0; r <= kRings; ++r) {
            for (std::uint32_t s = 0; s < sectors; ++s) {
                points.push_back(onBenchHead(1, kPi * static_cast<float>(r) / kRings,
                                             2 * kPi * static_cast<float>(s) / static_cast<float>(sectors)));
            }
        }
        for (std::uint32_t r = 0; r < kRings; ++r) {
            for (std::uint32_t s = 0; s < sectors; ++s) {
                const std::uint32_t a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
                for (const std::uint32_t i : {a, b, a + sectors, b, b + sectors, a + sectors})
                    indices.push_back(i);
            }
        }
    }
};

}  // namespace hairloom::cli
