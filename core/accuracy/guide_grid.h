// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Guides on a grid, for the tests of interpolation and its benchmark: made from numbers alone.

#include <utility>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom::scenes {

struct GuideGrid {
    std::uint32_t columns, rows;
    std::uint32_t points;  ///< per guide
    float spacing;         ///< metres between neighbours
    float height;          ///< metres
};

/// Guide s is rooted at column s mod columns along x and row s / columns along z, at y = 0, and bent over by
/// lean(s) metres of x at the tip. Each square of roots makes two triangles. There is no scalp.
template <class Lean>
Groom guidesOnGrid(const GuideGrid& grid, Lean lean) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < grid.columns * grid.rows; ++s) {
        const Vec3f root(grid.spacing * static_cast<float>(s % grid.columns), 0,
                         grid.spacing * static_cast<float>(s / grid.columns));
        for (std::uint32_t i = 0; i < grid.points; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(grid.points - 1);
            positions.push_back(root + Vec3f(lean(s) * t * t, grid.height * t, 0));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    for (std::uint32_t row = 0; row + 1 < grid.rows; ++row) {
        for (std::uint32_t column = 0; column + 1 < grid.columns; ++column) {
            const std::uint32_t a = row * grid.columns + column;
            groom.triangulation.triangles.push_back({a, a + grid.columns, a + 1});
            groom.triangulation.triangles.push_back({a + 1, a + grid.columns, a + grid.columns + 1});
        }
    }
    return groom;
}

}  // namespace hairloom::scenes
