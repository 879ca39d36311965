// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light at the border of a dielectric cylinder and inside it. Angles in radians; lengths in units of the
// fibre's radius. theta is the inclination against the plane across the fibre, gamma the angle against the
// surface normal in that plane, h = sin(gamma) the offset of the ray from the axis.

#include "core/base/math.h"

namespace hairloom::shading {

/// A skew ray behaves in the plane across the fibre as a flat one that meets these indices (Marschner et al.
/// 2003). Rünz 2012, footnote 5 prints the reciprocal.
struct BravaisIndices {
    double perpendicular;  ///< eta', bends the ray: sin(gamma_i) = eta' sin(gamma_t)
    double parallel;       ///< eta'', for light polarised in the plane of incidence
};
/// ior >= 1, |theta| < pi/2.
BravaisIndices bravaisIndices(double ior, double theta);

/// Reflected share of unpolarised light, 0…1; the same from inside (cosines of the same two angles).
double fresnel(const BravaisIndices& indices, double cosGammaOutside, double cosGammaInside);

/// What one inclination fixes for all offsets.
class CrossSection {
  public:
    /// `absorption` per fibre radius, RGB, >= 0.
    CrossSection(double ior, double theta, const Vec3d& absorption);

    const BravaisIndices& indices() const { return indices_; }
    /// sin(gamma_t) of a ray at the offset h, |h| <= 1.
    double sineInside(double h) const { return h / indices_.perpendicular; }

    /// What the border and the inside let through at the offset h, from which every path's attenuation
    /// follows.
    struct Ray {
        double reflected;  ///< F
        Vec3d transmittance;  ///< T of one way across: exp(−2 σ cos γ_t / cos θ_t); the thesis leaves cos θ_t
                              ///< out
    };
    Ray at(double h) const;

  private:
    BravaisIndices indices_;
    Vec3d absorption_;
    double pathScale_;  ///< 2 / cos θ_t
};

/// A_p of Eq. 45: p = 0 (R): F; p >= 1: (1 − F)² F^(p−1) T^p. 0…1.
Vec3d attenuation(const CrossSection::Ray& ray, int p);
/// A_p of the orders from p on, added up in closed form; p >= 1.
Vec3d attenuationFrom(const CrossSection::Ray& ray, int p);

}  // namespace hairloom::shading
