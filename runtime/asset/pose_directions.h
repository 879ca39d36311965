// SPDX-License-Identifier: MIT
#pragma once
// Directions of an asset's poses: a sphere as an octahedron, whose lower half is folded over the upper one
// (Meyer et al. 2010, "On Floating-Point Normal Vectors").

#include <algorithm>
#include <cmath>

#include "hairloom/asset_format.h"
#include "hairloom/math.h"

namespace hairloom::runtime {

namespace octahedron {

inline float signOf(float value) {
    return value < 0.0f ? -1.0f : 1.0f;
}
/// Between the two halves of the square, of coordinates within ±1.
inline Float3 folded(Float3 v) {
    return {(1.0f - std::abs(v.y)) * signOf(v.x), (1.0f - std::abs(v.x)) * signOf(v.y), v.z};
}

}  // namespace octahedron

/// Of length 1, whatever the bits are.
inline Float3 directionOf(const asset::PoseDirection& packed) {
    const auto share = [](std::int16_t value) {
        return std::max(static_cast<float>(value) / 32767.0f, -1.0f);
    };
    Float3 v{share(packed[0]), share(packed[1]), 0.0f};
    v.z = 1.0f - std::abs(v.x) - std::abs(v.y);
    if (v.z < 0.0f) v = octahedron::folded(v);
    return v * (1.0f / length(v));
}

/// Of a direction of length 1: within asset::kPoseDirectionError of it. Of the four that it lies between, the
/// nearest, which rounding alone does not find.
inline asset::PoseDirection packedDirection(Float3 direction) {
    Float3 v = direction * (1.0f / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z)));
    if (v.z < 0.0f) v = octahedron::folded(v);
    const auto below = [](float share) {
        return std::clamp(std::floor(share * 32767.0f), -32767.0f, 32766.0f);
    };
    const float x = below(v.x), y = below(v.y);
    asset::PoseDirection nearest{};
    float least = 5.0f;
    for (const float right : {0.0f, 1.0f}) {
        for (const float up : {0.0f, 1.0f}) {
            const asset::PoseDirection tried{static_cast<std::int16_t>(x + right),
                                             static_cast<std::int16_t>(y + up)};
            const Float3 off = directionOf(tried) - direction;
            const float squared = dot(off, off);
            if (squared < least) {
                least = squared;
                nearest = tried;
            }
        }
    }
    return nearest;
}

}  // namespace hairloom::runtime
