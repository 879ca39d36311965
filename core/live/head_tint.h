// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

/// Albedo (linear RGB) of each vertex of the groom's head, which it has: skin, and where hair grows half its
/// colour, as roots too fine to be drawn one by one shade the skin between them. It fades where roots get
/// sparse, over about the distance that they have from each other elsewhere, at most 8 mm.
std::vector<Vec3f> headTint(const Groom& groom, const Vec3f& skin);

}  // namespace hairloom
