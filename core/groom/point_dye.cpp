// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/point_dye.h"

#include <algorithm>

namespace hairloom {

std::vector<float> pointDyes(const Groom& groom) {
    const auto points = groom.pointAttributes.view<float>(attribute::kPointDye);
    if (points.size() == groom.pointCount()) return {points.begin(), points.end()};
    const auto strands = groom.strandAttributes.view<float>(attribute::kDye);
    std::vector<float> mask(groom.pointCount(), groom.material.dyeStrength > 0 ? 1.0f : 0.0f);
    if (strands.size() != groom.strandCount()) return mask;
    for (std::size_t s = 0; s < strands.size(); ++s)
        std::fill(mask.begin() + groom.offsets[s], mask.begin() + groom.offsets[s + 1], strands[s]);
    return mask;
}

}  // namespace hairloom
