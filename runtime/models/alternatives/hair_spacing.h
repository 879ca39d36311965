// SPDX-License-Identifier: MIT
#pragma once
// What continua of hair take from the strands at rest.

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/checks.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Whether a point takes part: its speed is a number and its position within 1e6 m.
inline bool countsIn(Float3 position, Float3 velocity) {
    return isFinite(velocity) && isFinite(position) && dot(position, position) <= kFarthest * kFarthest;
}

/// Metres of hair that each point carries: half of its two segments.
inline std::vector<float> massesOf(const StrandsView& strands) {
    std::vector<float> masses(strands.restPositions_ss.size(), 0.0f);
    for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s) {
        for (std::uint32_t p = strands.offsets[s]; p + 1 < strands.offsets[s + 1]; ++p) {
            const float half = 0.5f * length(strands.restPositions_ss[p + 1] - strands.restPositions_ss[p]);
            masses[p] += half;
            masses[p + 1] += half;
        }
    }
    return masses;
}

/// Metres: the mean length of a segment, or the mean distance of a root from the nearest other one where that
/// is larger. Of at most 512 roots, evenly picked.
inline float spacingOf(const StrandsView& strands) {
    constexpr std::size_t kMostRoots = 512;
    const std::size_t count = strands.offsets.size() - 1;
    const std::size_t stride = (count + kMostRoots - 1) / kMostRoots;
    double distances = 0.0, lengths = 0.0;
    std::size_t found = 0;
    for (std::size_t s = 0; s < count && count > 1; s += stride) {
        const Float3 root = strands.restPositions_ss[strands.offsets[s]];
        float nearest = std::numeric_limits<float>::max();
        for (std::size_t other = 0; other < count; ++other) {
            if (other != s)
                nearest = std::min(nearest, length(strands.restPositions_ss[strands.offsets[other]] - root));
        }
        distances += static_cast<double>(nearest);
        ++found;
    }
    for (const float mass : massesOf(strands)) lengths += static_cast<double>(mass);
    const double segment = lengths / static_cast<double>(strands.restPositions_ss.size() - count);
    const double apart = found > 0 ? distances / static_cast<double>(found) : 0.0;
    return static_cast<float>(std::max(segment, apart));
}

}  // namespace hairloom::runtime
