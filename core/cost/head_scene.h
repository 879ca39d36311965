// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A head and its hair made from numbers, which tests and benchmarks of pictures share: an ellipsoid of the
// size of a head around the origin, in metres.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/math.h"
#include "core/base/random.h"

namespace hairloom::scenes {

/// A point of the ellipsoid grown by a factor; angles in radians from its crown and about the vertical.
inline Vec3f onHead(float size, float down, float around) {
    return {size * 0.075f * std::sin(down) * std::cos(around), size * 0.11f * std::cos(down),
            size * 0.095f * std::sin(down) * std::sin(around)};
}

/// Its skin: triangles, counter-clockwise from outside.
struct HeadSkin {
    std::vector<Vec3f> points;
    std::vector<std::uint32_t> indices;

    HeadSkin(std::uint32_t rings, std::uint32_t sectors) {
        for (std::uint32_t r = 0; r <= rings; ++r) {
            for (std::uint32_t s = 0; s < sectors; ++s) {
                points.push_back(onHead(1, kPi * static_cast<float>(r) / static_cast<float>(rings),
                                        2 * kPi * static_cast<float>(s) / static_cast<float>(sectors)));
            }
        }
        for (std::uint32_t r = 0; r < rings; ++r) {
            for (std::uint32_t s = 0; s < sectors; ++s) {
                const std::uint32_t a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
                for (const std::uint32_t i : {a, b, a + sectors, b, b + sectors, a + sectors})
                    indices.push_back(i);
            }
        }
    }
};

/// Strands of 8 points combed down from the crown, of one radius.
struct CombedStrands {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    std::vector<float> radii;

    explicit CombedStrands(std::uint32_t count) {
        constexpr int kPoints = 8;
        constexpr float kRadius = 0.00015f;
        Random random(11);
        for (std::uint32_t i = 0; i < count; ++i) {
            const float around = random.uniform(0, 2 * kPi);
            const float down = random.uniform(0.05f, 1.2f);
            const float lift = random.uniform(1.02f, 1.12f);
            for (int k = 0; k < kPoints; ++k) {
                const float size = 1 + (lift - 1) * std::min(1.0f, static_cast<float>(k) / 2);
                positions.push_back(onHead(size, down + 0.16f * static_cast<float>(k), around));
                radii.push_back(kRadius);
            }
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        }
    }
};

}  // namespace hairloom::scenes
