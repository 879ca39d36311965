// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light that other fibres have scattered before: dual scattering (Zinke et al. 2008). A fibre is reduced to
// the shares of light that it sends on and back on average; how many fibres lie before the point and in all
// comes from the shadow maps.
//
// What is different here. Zinke et al. multiply the forward shares of the fibres before the point, and add
// the light that turns back behind it, up to three turns, as of sheets that let no light pass between fibres.
// Fibres here lie at random: light among them obeys the equation of transfer, in the plane across them, which
// is solved as far as the mean light and its direction (P1) over hair of finite depth on black or a matte
// ground, all turns included. A fibre sends much light nearly straight on, which P1 cannot hold: as much as
// the second moment of its N says counts as not scattered at all (delta-Eddington: Joseph, Wiscombe and
// Weinman 1976, "The Delta-Eddington Approximation for Radiative Flux Transfer", with cosines of the circle
// in place of Legendre's polynomials).
//
// Angles in radians, colours linear RGB, 0 the azimuth back towards the light, as in marschner.h.

#include <optional>

#include "core/shading/sadeghi.h"

namespace hairloom::shading {

/// A fibre's average scattering of light that comes at the inclination θ_d from anywhere around it.
struct AverageScattering {
    Vec3d forward =
        Vec3d::Zero();  ///< ā_f, 0…1: to the half of directions away from where the light came from
    Vec3d backward = Vec3d::Zero();  ///< ā_b, 0…1; ā_f + ā_b is the albedo
    double forwardVariance = 0;      ///< β̄_f² in θ_h, of all channels together
    double backwardVariance = 0;     ///< β̄_b²
    double forwardTilt = 0;          ///< ᾱ_f in θ_h
    double backwardTilt = 0;         ///< ᾱ_b
    /// Of each channel, times its share: what adds up to those of all channels.
    Vec3d forwardVariances = Vec3d::Zero(), backwardVariances = Vec3d::Zero();
    Vec3d forwardTilts = Vec3d::Zero(), backwardTilts = Vec3d::Zero();
    /// ∫ N cos ψ and ∫ N cos 2ψ over the angles ψ by which light is turned, of all lobes.
    Vec3d first = Vec3d::Zero(), second = Vec3d::Zero();

    double tilt() const;      ///< of all light
    double variance() const;  ///< in θ_h, of all light
};

/// Light inside a layer of hair, by the number of fibres that a ray straight through meets on average.
struct LayerLight {
    Vec3d fluence = Vec3d::Zero();  ///< of diffuse light, the integral of its radiance around the fibre
    Vec3d flux = Vec3d::Zero();     ///< the same, by the cosine of its angle to the light's way
    Vec3d onward = Vec3d::Zero();   ///< of a beam, what goes its way still: exp(−before), and what is
                                    ///< scattered straight on
};
/// Lit with the irradiance 1 straight from one side. `before` fibres between the point and the light, `all`
/// >= before from one side of the hair to the other, where it lies on a ground of this albedo.
LayerLight beamInLayer(const AverageScattering& fibre, double before, double all,
                       const Vec3d& ground = Vec3d::Zero());

class DualScattering {
  public:
    explicit DualScattering(const Marschner& model);
    /// Colours and intensities that would give more light than they get are taken as giving 0.995 of it.
    explicit DualScattering(const SadeghiParameters& model)
        : DualScattering(model, SadeghiLongitudinal(model)) {}
    DualScattering(const SadeghiParameters& model, SadeghiLongitudinal longitudinal);

    /// N of all lobes, by φ as AzimuthalProfile::Grid.
    using Profile = std::array<std::array<float, AzimuthalProfile::kGridSize>, 3>;
    struct Row {
        AverageScattering average;
        Profile profile;
    };
    Row at(double thetaD) const;

    /// ∫ N cos mφ of one lobe around the fibre, m = 0 … 3.
    using Moments = std::array<Vec3d, 4>;
    std::array<Moments, 3> moments(double thetaD) const;
    /// M of a lobe, with which those N make S = Σ M N / cos²θ_d.
    double longitudinal(Lobe lobe, double thetaIn, double thetaOut) const;

  private:
    struct Lobes;
    Lobes lobes(double thetaD) const;

    const Marschner* marschner_ = nullptr;
    SadeghiParameters sadeghi_;
    std::optional<SadeghiLongitudinal> longitudinal_;  ///< of Sadeghi's
};

/// The mean number of scatterings of light that has been scattered at all, of Poisson's distribution with the
/// mean x >= 0.
double scatteringsOf(double x);

/// What leaves the point towards the view of light that other fibres have scattered, as S cos θ_i of
/// Marschner's: times the irradiance that the hair's lit side gets.
Vec3d multipleScattering(const DualScattering::Row& row, double thetaIn, double thetaOut, double phi,
                         double before, double all, const Vec3d& ground = Vec3d::Zero());

/// The longitudinal spread of such light.
double spreadLongitudinal(double tilt, double variance, double thetaIn, double thetaOut);

}  // namespace hairloom::shading
