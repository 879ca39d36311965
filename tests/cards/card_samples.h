// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair without a groom: locks on a ball.

#include <cmath>

#include "core/base/random.h"
#include "core/cards/hair.h"

namespace hairloom::cards {

/// Strands of `points` points each that hang from the upper half of a ball of 0.1 m.
inline Hair ballHair(std::uint32_t strands, std::uint32_t points = 12) {
    Hair hair;
    for (std::uint32_t s = 0; s < strands; ++s) {
        Random random(7, s);
        const float turn = random.uniform(0, 2 * kPi), up = random.uniform(0.3f, 0.98f);
        const float level = std::sqrt(1 - up * up);
        const Vec3f out(level * std::cos(turn), up, level * std::sin(turn));
        const float length = random.uniform(0.12f, 0.16f);
        for (std::uint32_t p = 0; p < points; ++p) {
            const float t = static_cast<float>(p) / static_cast<float>(points - 1);
            const Vec3f aside(out.x(), 0, out.z());
            hair.positions_ws.push_back(0.1f * out + length * t * (0.6f * out + 0.4f * aside) -
                                        Vec3f(0, 1.1f * length * t * t, 0));
            hair.radii.push_back(0.0003f * (1 - 0.5f * t));
            hair.albedo.push_back((1 - t) * Vec3f(0.2f, 0.1f, 0.05f) + t * Vec3f(0.5f, 0.3f, 0.15f));
        }
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
        hair.rootNormals_ws.push_back(out);
    }
    return hair;
}

/// A head below all of the hair of a ball.
inline void addBallHead(Hair& hair) {
    constexpr std::uint32_t kAround = 32;
    for (std::uint32_t row = 0; row <= kAround / 2; ++row) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const float up = kPi * static_cast<float>(row) / (kAround / 2),
                        turn = 2 * kPi * static_cast<float>(i) / kAround;
            hair.headPositions_ws.push_back(
                0.099f * Vec3f(std::sin(up) * std::cos(turn), std::cos(up), std::sin(up) * std::sin(turn)));
            if (row == 0) continue;
            const std::uint32_t last = (row - 1) * kAround, next = row * kAround, j = (i + 1) % kAround;
            for (const std::uint32_t k : {last + i, next + j, next + i, last + i, last + j, next + j})
                hair.headIndices.push_back(k);
        }
    }
}

/// A flat ribbon: strands side by side along -Y in the plane of x, z up to `thickness` apart from it.
inline Hair ribbonHair(std::uint32_t strands, float width, float thickness) {
    Hair hair;
    for (std::uint32_t s = 0; s < strands; ++s) {
        Random random(3, s);
        const float x = random.uniform(-0.5f, 0.5f) * width, z = random.uniform(-0.5f, 0.5f) * thickness;
        for (int p = 0; p < 8; ++p) {
            hair.positions_ws.emplace_back(x, -0.02f * static_cast<float>(p), z);
            hair.radii.push_back(0.0002f);
            hair.albedo.emplace_back(0.3f, 0.2f, 0.1f);
        }
        hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
        hair.rootNormals_ws.emplace_back(0, 0, 1);
    }
    return hair;
}

}  // namespace hairloom::cards
