// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How deep hair is in the head and in the collision spheres, for the heat map.

#include <span>
#include <vector>

#include "core/groom/groom.h"
#include "core/operations/skin.h"

namespace hairloom::editing {

struct Penetration {
    std::vector<float> perPoint;  ///< metres, ≥ 0; the deeper of skin and spheres
    float worst = 0;              ///< metres
    std::size_t points = 0;       ///< that are inside anything by more than a micrometre
};

/// Roots are on the skin and count as outside. `skin` may be null; positions as Groom::positions(), or of a
/// moving frame with spheres where they are then.
Penetration penetrationOf(std::span<const std::uint32_t> offsets, std::span<const Vec3f> positions,
                          std::span<const CollisionSphere> spheres, const SkinQuery* skin);

}  // namespace hairloom::editing
