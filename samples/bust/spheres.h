// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Collision spheres that fill head, neck and shoulders from inside.

#include <string>
#include <vector>

#include "samples/bust/mesher.h"

namespace hairloom::bust {

struct Sphere {
    std::string name;
    Vec3d centre;   ///< metres, in the rest pose
    double radius;  ///< metres
    int bone;       ///< index into bones()
};

/// Deepest that a sphere may stand out of the surface, in metres.
inline constexpr double kProtrusion = 0.002;

/// Spheres for the neck and the shoulders at fixed places, and for the head those of a grid inside it that
/// cover most of the scalp, chosen one by one (or in mirrored pairs).
std::vector<Sphere> fitSpheres(const PatchMesh& mesh);

/// A list of {"name", "centre", "radius", "bone"}.
std::string spheresJson(const std::vector<Sphere>& spheres);

}  // namespace hairloom::bust
