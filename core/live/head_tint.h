// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

/// How much of the hair's colour each vertex of the groom's head has, which it has: half where hair grows, as
/// roots too fine to be drawn one by one shade the skin between them. It fades where roots get sparse, over
/// about the distance that they have from each other elsewhere, at most 8 mm.
std::vector<float> headTint(const Groom& groom);

/// Albedo (linear RGB) of skin with such shares of a colour.
std::vector<Vec3f> tinted(const Vec3f& skin, const Vec3f& colour, std::span<const float> shares);

}  // namespace hairloom
