// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands that are laid along a path: gathered over the head, then where braids and buns lead.

#include <span>
#include <vector>

#include "core/operations/skin.h"

namespace hairloom {

/// From the root over the head to a goal, about `height` (metres) over the skin. The root comes first, the
/// goal last.
std::vector<Vec3f> pathOverHead(const SkinQuery& skin, const Vec3f& root, const Vec3f& goal, float height);

/// Puts the points onto the path, which begins at points[0]; segments have these lengths then. Behind its end
/// it goes on straight.
void layAlong(std::span<Vec3f> points, std::span<const float> lengths, std::vector<Vec3f> path);

}  // namespace hairloom
