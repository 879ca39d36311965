// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Kajiya and Kay's hair model (1989) as Rünz 2012, section 5.1, condenses and normalises it; the
// double-precision reference of runtime/shaders/kajiya.hlsli. All vectors are unit vectors that point away
// from the fibre; the tangent's sign does not matter.

#include "core/base/math.h"

namespace hairloom::shading {

/// sin(t, l): how much of the light meets the fibre (Eq. 25). 0…1.
double kajiyaDiffuse(const Vec3d& tangent, const Vec3d& toLight);

/// cos^m of the angle between the view and the cone of mirrored light (Eq. 25), m >= 0. 0…1.
double kajiyaSpecular(const Vec3d& tangent, const Vec3d& toLight, const Vec3d& toView, double exponent);

/// R_O(l)_Max = 2 * integral of sin^(m+2) over 0…pi (Eq. 31, whose Table 2 is wrong), in closed form; m >= 0.
double kajiyaReflectance(double exponent);

struct KajiyaKay {
    double diffuse = 0.5;   ///< c_d, 0…1
    double specular = 0.5;  ///< c_s, 0…1; c_d + c_s <= 1 conserves energy
    double exponent = 20;   ///< m, >= 0
};

/// Radiance towards the view per irradiance perpendicular to the light. Eq. 32, but each term divided by its
/// own R_O (that of the diffuse term is R_O at m = 0) and both multiplied by sin(t, l): then the light sent
/// out over the whole sphere is at most (c_d + c_s) of what meets the fibre, from every direction.
double evaluate(const KajiyaKay& model, const Vec3d& tangent, const Vec3d& toLight, const Vec3d& toView);

/// The factor that keeps a fibre whose terms would send out `weights` of the light in all at 1: each term's
/// weight over its own R_O, so that none sends out more than that from or towards any direction.
double kajiyaBound(double weights);

}  // namespace hairloom::shading
