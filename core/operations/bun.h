// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where a bun sits that nobody has placed.

#include "core/groom/groom.h"

namespace hairloom {

/// Metres, in the scalp's rest space, and a direction of length 1.
struct BunPlace {
    Vec3f centre, axis;
};
/// A centre of zero becomes high at the back of the head, `thickness` (m) out of the skin. An axis of zero
/// points out of the skin there. The groom has a scalp.
BunPlace bunPlace(const Groom& groom, const Vec3f& centre, const Vec3f& axis, float thickness);

}  // namespace hairloom
