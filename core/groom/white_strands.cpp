// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/white_strands.h"

#include <cmath>
#include <cstdint>

#include "core/base/cell_stream.h"
#include "core/base/random.h"

namespace hairloom {

bool isWhite(const HairMaterial& material, const Vec3f& root_ss) {
    if (!(material.greyShare > 0)) return false;
    // Half as wide as a hair: files that round coordinates leave nearly all roots in their cells.
    constexpr double kPerMetre = 2e4;
    const auto cellOf = [](float metres) {
        return static_cast<std::int64_t>(std::llround(kPerMetre * static_cast<double>(metres)));
    };
    const std::uint64_t stream = streamOf({cellOf(root_ss.x()), cellOf(root_ss.y()), cellOf(root_ss.z())});
    return Random(material.greySeed, stream).uniformDouble() < static_cast<double>(material.greyShare);
}

}  // namespace hairloom
