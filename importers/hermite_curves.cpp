// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/hermite_curves.h"

#include <cstddef>

namespace hairloom {

std::vector<float> bezierOfHermite(std::span<const std::uint32_t> counts, std::span<const float> points,
                                   std::span<const float> tangents) {
    std::vector<float> controls;
    controls.reserve(3 * points.size());
    const auto add = [&](std::size_t point, float share) {
        for (std::size_t c = 3 * point; c < 3 * point + 3; ++c)
            controls.push_back(points[c] + share * tangents[c]);
    };
    std::size_t first = 0;
    for (const std::uint32_t count : counts) {
        for (std::size_t i = first; i < first + count; ++i) {
            if (i > first) add(i, -1.0f / 3);
            add(i, 0);
            if (i + 1 < first + count) add(i, 1.0f / 3);
        }
        first += count;
    }
    return controls;
}

}  // namespace hairloom
