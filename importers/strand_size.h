// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether hair has the size of hair.

#include <optional>
#include <span>

#include "core/groom/validate.h"

namespace hairloom {

/// A warning where the median strand length or the spread of the roots is implausible for the hair or fur of
/// any head, naming the unit of `--unit` that would fit best. `positions` are metres at `metresPerUnit`.
std::optional<Finding> implausibleSize(std::span<const std::uint32_t> offsets,
                                       std::span<const Vec3f> positions, float metresPerUnit);

}  // namespace hairloom
