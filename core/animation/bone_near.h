// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "core/animation/actor.h"

namespace hairloom {

/// Name of the bone nearest to a point of the head at rest, each bone reaching from its joint to those of its
/// children; empty where the skeleton is.
std::string boneNear(const Skeleton& skeleton, const Vec3f& point_ss);

/// Name of the bone that moves most of the skin around a sphere's surface, which may be another than the
/// nearest where a rig has bones that only help; boneNear() where no skin is there.
std::string boneUnder(const Actor& actor, const Vec3f& centre_ss, float radius);

}  // namespace hairloom
