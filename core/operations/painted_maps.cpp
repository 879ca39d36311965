// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/painted_maps.h"

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/groom/point_dye.h"

namespace hairloom {
namespace {

std::uint32_t numberOf(MaskMap map) {
    return static_cast<std::uint32_t>(map) - static_cast<std::uint32_t>(MaskMap::mask1) + 1;
}

}  // namespace

std::vector<float> paintedValues(const Groom& groom, MaskMap map) {
    if (map == MaskMap::dye) return pointDyes(groom);
    std::vector<float> values(groom.pointCount(), map == MaskMap::none ? 1.0f : 0.0f);
    if (map == MaskMap::none) return values;
    const auto painted = map == MaskMap::density
                             ? std::span<const float>()
                             : groom.strandAttributes.view<float>(maskAttribute(numberOf(map)));
    const std::vector<SurfacePoint> roots =
        map == MaskMap::density ? groom.rootBindings() : std::vector<SurfacePoint>();
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        float value = s < painted.size() ? painted[s] : 0.0f;
        if (s < roots.size()) {
            const Triangle& corners = groom.scalp->triangles()[roots[s].triangle];
            value = groom.scalpDensity.empty() ? 1.0f : 0.0f;
            for (int c = 0; c < 3 && !groom.scalpDensity.empty(); ++c)
                value += roots[s].barycentric[c] * groom.scalpDensity[corners[static_cast<std::size_t>(c)]];
        }
        std::fill(values.begin() + groom.offsets[s], values.begin() + groom.offsets[s + 1], value);
    }
    return values;
}

std::string paintedState(const Groom& groom, MaskMap map) {
    switch (map) {
        case MaskMap::none:
            return {};
        case MaskMap::density:
            return fmt::format("density {:x}", hashOf(std::span<const float>(groom.scalpDensity)));
        case MaskMap::dye:
            return fmt::format("dye {} {} {}", groom.pointAttributes.version(attribute::kPointDye),
                               groom.strandAttributes.version(attribute::kDye),
                               groom.material.dyeStrength > 0);
        default:
            return fmt::format("mask {}", groom.strandAttributes.version(maskAttribute(numberOf(map))));
    }
}

}  // namespace hairloom
