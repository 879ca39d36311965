// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From what hair is made of, or what colour it shall have, to what its inside absorbs. The groups of Rünz
// 2012, Table 1 with their melanin are runtime/presets.h.

#include "core/base/math.h"

namespace hairloom::shading {

/// Concentrations as in Chiang et al. 2016: eumelanin 0.3 is blond, 1.3 brown, 8 black; pheomelanin reddens.
struct Melanin {
    double eumelanin = 1.3;    ///< 0…8
    double pheomelanin = 0.0;  ///< 0…8
};

/// RGB per fibre radius: d'Eon et al. 2011 (measured for a fibre's radius as the unit).
Vec3d absorption(const Melanin& melanin);

/// RGB per fibre radius that gives a volume of such hair the colour, linear 0…1, under all scattering: the
/// fit of Chiang et al. 2016. `azimuthalRoughness` 0…1. 0 of a channel is taken as 0.001.
Vec3d absorptionOfColour(const Vec3d& colour, double azimuthalRoughness);
/// The other way.
Vec3d colourOfAbsorption(const Vec3d& absorption, double azimuthalRoughness);
/// It is (ln c · this)².
double absorptionScale(double azimuthalRoughness);
/// The colour of Kajiya-Kay's fibres that absorb so much, linear 0…1: the square root of that of a volume.
/// Light that much hair sends back has been coloured on its way in and, as much, on its way out: a deep layer
/// reflects (1 − γ)/(1 + γ) ≈ e^(−γ) · e^(−γ) of diffuse light (Hapke 1981, γ = √(1 − albedo)). Shadows
/// colour the way in of Kajiya-Kay's light already.
Vec3d kajiyaColour(const Vec3d& absorption, double azimuthalRoughness);

/// β of the R lobe in θ_h, radians, of a roughness 0…1 (Chiang et al. 2016, whose variance is one of
/// θ_o).
double longitudinalWidth(double roughness);
/// The standard deviation in radians of the azimuthal spread (Chiang et al. 2016: the scale of a
/// logistic).
double azimuthalWidth(double roughness);

/// Long over short axis >= 1 of a cross-section with the numerical eccentricity √(1 − b²/a²), 0…0.95.
double axisRatio(double eccentricity);

}  // namespace hairloom::shading
