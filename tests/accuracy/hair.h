// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "core/groom/groom.h"

namespace hairloom::test {

/// Strands of 20 cm with `points` points, side by side 5 mm apart, sticking out along x.
inline Groom straightHair(std::uint32_t strands, std::uint32_t points) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < strands; ++s) {
        for (std::uint32_t p = 0; p < points; ++p) {
            const float along = 0.2f * static_cast<float>(p) / static_cast<float>(points - 1);
            positions.emplace_back(along, 1.6f, 0.005f * static_cast<float>(s));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

}  // namespace hairloom::test
