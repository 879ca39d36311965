// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands made from numbers, for scenes and tests of the engine alone.

#include <cmath>
#include <cstdint>
#include <vector>

#include "hairloom/strands.h"

namespace hairloom {

struct StrandSet {
    std::vector<std::uint32_t> offsets{0};
    std::vector<runtime::Float3> points;  ///< at rest, metres
    std::vector<float> masses;            ///< of points, or none
    std::vector<float> stiffness;         ///< of strands, as runtime::StrandsView has it, or none

    void add(const std::vector<runtime::Float3>& strand) {
        points.insert(points.end(), strand.begin(), strand.end());
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    /// `count` points in one direction of unit length, `segment` metres apart.
    void add(runtime::Float3 root, runtime::Float3 direction, float segment, std::uint32_t count) {
        for (std::uint32_t p = 0; p < count; ++p)
            points.push_back(root + direction * (segment * static_cast<float>(p)));
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }

    runtime::StrandsView view() const { return {offsets, points, {}, masses, stiffness}; }
    std::uint32_t count() const { return static_cast<std::uint32_t>(offsets.size() - 1); }
    /// Roots in their rest positions, turned about the origin, then moved.
    std::vector<runtime::RootFrame> roots(runtime::Float3 shift = {}, runtime::Quat turn = {}) const {
        std::vector<runtime::RootFrame> result;
        for (std::uint32_t s = 0; s < count(); ++s)
            result.push_back({rotate(turn, points[offsets[s]]) + shift, turn});
        return result;
    }
};

/// Direction in the plane of x and y, `angle` radians from straight down.
inline runtime::Float3 hangingAt(float angle) {
    return {std::sin(angle), -std::cos(angle), 0.0f};
}
inline runtime::Quat turnAboutY(float angle) {
    return {0.0f, std::sin(0.5f * angle), 0.0f, std::cos(0.5f * angle)};
}

/// Eight straight strands whose roots stand around (0, 0.1, 0) and which hang and stand out in all
/// directions.
inline StrandSet tuft(std::uint32_t points = 16, float segment = 0.012f) {
    StrandSet strands;
    for (std::uint32_t s = 0; s < 8; ++s) {
        const float f = static_cast<float>(s);
        const float around = 0.7f * f;
        const runtime::Float3 out{std::sin(around), 0.0f, std::cos(around)};
        const float angle = 0.1f + 0.2f * f;  // from straight down
        const auto direction = out * std::sin(angle) + runtime::Float3{0.0f, -std::cos(angle), 0.0f};
        strands.add(runtime::Float3{0.0f, 0.1f, 0.0f} + out * 0.02f, direction, segment, points);
    }
    return strands;
}

}  // namespace hairloom
