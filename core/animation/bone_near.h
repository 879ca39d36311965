// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "core/animation/skeleton.h"

namespace hairloom {

/// Name of the bone nearest to a point of the head at rest, each bone reaching from its joint to those of its
/// children; empty where the skeleton is.
std::string boneNear(const Skeleton& skeleton, const Vec3f& point_ss);

}  // namespace hairloom
