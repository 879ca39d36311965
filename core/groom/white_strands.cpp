// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/white_strands.h"

#include <cmath>
#include <cstdint>

#include "core/base/random.h"

namespace hairloom {

bool isWhite(const HairMaterial& material, const Vec3f& root_ss) {
    if (!(material.greyShare > 0)) return false;
    // Half as wide as a hair: files that round coordinates leave nearly all roots in their cells.
    constexpr double kPerMetre = 2e4;
    std::uint64_t stream = 0;
    for (int c = 0; c < 3; ++c) {
        const auto place =
            static_cast<std::int64_t>(std::llround(kPerMetre * static_cast<double>(root_ss[c])));
        stream = stream << 21u ^ (static_cast<std::uint64_t>(place) & 0x1fffffu);
    }
    return Random(material.greySeed, stream).uniformDouble() < static_cast<double>(material.greyShare);
}

}  // namespace hairloom
