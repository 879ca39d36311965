// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether hair has the size of hair.

#include <optional>
#include <span>

#include "core/base/result.h"
#include "core/groom/validate.h"

namespace hairloom {

/// Metres from the origin along an axis that no point of hair may be beyond.
inline constexpr float kFarthestPoint = 1000;

/// A point of hair that is beyond it.
struct FarPoint {
    std::uint32_t strand = 0;  ///< of the file, from 0
    std::uint32_t point = 0;   ///< of the strand, from 0
    float metres = 0;          ///< its greatest coordinate
};
/// Which strand it is and the unit that would fit the others, where one does. `positions` as below.
Error tooFar(const FarPoint& far, std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions,
             float metresPerUnit);

/// A warning where the median strand length or the spread of the roots is implausible for the hair or fur of
/// any head, naming the unit of `--unit` that would fit best. `positions` are metres at `metresPerUnit`.
std::optional<Finding> implausibleSize(std::span<const std::uint32_t> offsets,
                                       std::span<const Vec3f> positions, float metresPerUnit);

}  // namespace hairloom
