// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands made from numbers, for scenes of the engine alone.

#include <cstdint>
#include <vector>

#include "hairloom/strands.h"

namespace hairloom {

struct StrandSet {
    std::vector<std::uint32_t> offsets{0};
    std::vector<runtime::Float3> points;  ///< at rest, metres
    std::vector<float> masses;            ///< of points, or none

    void add(const std::vector<runtime::Float3>& strand);
    /// `count` points in one direction of unit length, `segment` metres apart.
    void addStraight(runtime::Float3 root, runtime::Float3 direction, float segment, std::uint32_t count);

    runtime::StrandsView view() const { return {offsets, points, {}, masses}; }
    std::uint32_t count() const { return static_cast<std::uint32_t>(offsets.size() - 1); }
    /// Roots in their rest places, turned about the origin, then moved.
    std::vector<runtime::RootFrame> roots(runtime::Float3 shift = {}, runtime::Quat turn = {}) const;
};

/// Direction in the plane of x and y, `angle` radians from straight down.
runtime::Float3 hangingAt(float angle);
runtime::Quat turnAboutY(float angle);

/// Eight straight strands whose roots stand around (0, 0.1, 0) and which hang and stand out in all
/// directions.
StrandSet tuft(std::uint32_t points = 16, float segment = 0.012f);

}  // namespace hairloom
