// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/move_strands.h"

#include <algorithm>

namespace hairloom {

void moveStrands(Groom& groom, std::span<const std::uint32_t> strands, std::span<const Vec3f> points) {
    const auto offsets = groom.offsets.view();
    std::vector<Vec3f>& all = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    auto from = points.begin();
    for (const std::uint32_t s : strands) {
        const auto count = static_cast<std::ptrdiff_t>(offsets[s + 1] - offsets[s]);
        std::copy_n(from, count, all.begin() + static_cast<std::ptrdiff_t>(offsets[s]));
        from += count;
    }
}

}  // namespace hairloom
