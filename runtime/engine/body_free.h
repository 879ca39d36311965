// SPDX-License-Identifier: MIT
#pragma once
// How much room there is around a place beside a body, and which bones move what is there.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "hairloom/body_field.h"
#include "hwy/base.h"

namespace hairloom::runtime {

/// Shares of a distance and of a cell that are sure.
inline constexpr float kBodySure = 0.9f, kBodyUnsure = 0.2f, kBodyUnsureFine = 0.05f;

/// Metres that a body is away at least from a place at `distance` of it: what is interpolated, and posed, may
/// be closer than it seems; where cells are small, by less. Below 0 where it is not away.
inline float surelyFree(float distance, float cell) {
    return kBodySure * distance - (distance < BodyField::kFineReach ? kBodyUnsureFine : kBodyUnsure) * cell;
}

/// A corner of a table, and how many cells it is away.
struct Corner {
    std::size_t index;
    float away;
};

/// `cells` from the first corner of the table; the nearest of its corners also from beyond it.
HWY_INLINE Corner nearestCorner(const BodyField& field, Float3 cells) {
    const auto nearest = [](float at, std::uint32_t most) {
        return std::min(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::max(at, 0.0f) + 0.5f)),
                        most);
    };
    const std::uint32_t x = nearest(cells.x, field.size[0]), y = nearest(cells.y, field.size[1]),
                        z = nearest(cells.z, field.size[2]);
    const Float3 at{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    return {(std::size_t{z} * (field.size[1] + 1) + y) * (field.size[0] + 1) + x, length(cells - at)};
}

/// Of 255, how much a bone moves what is near a place at rest.
HWY_INLINE unsigned shareOf(const BodyField& field, std::size_t bone, Float3 point_ss) {
    const Corner corner = nearestCorner(field, (point_ss - field.low_ss) * (1 / field.cell));
    const BodyField::Skin& skin = field.palette[field.skins[corner.index]];
    unsigned share = 0;
    for (std::size_t i = 0; i < skin.bones.size(); ++i) share += skin.bones[i] == bone ? skin.weights[i] : 0u;
    return share;
}

/// Metres from a box at least: the longest way along an axis.
HWY_INLINE float distanceTo(const BodyField::Box& box, Float3 p) {
    const auto beside = [](float at, float low, float high) { return std::max(low - at, at - high); };
    return std::max({beside(p.x, box.low.x, box.high.x), beside(p.y, box.low.y, box.high.y),
                     beside(p.z, box.low.z, box.high.z), 0.0f});
}

}  // namespace hairloom::runtime
