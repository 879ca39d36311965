// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light that other fibres have scattered before: dual scattering (Zinke et al. 2008). A fibre is reduced to
// the shares of light that it sends on and back on average; how many fibres lie before the point and in all
// comes from the shadow maps.
//
// What is different here. Zinke et al. multiply the forward shares of the fibres before the point, and add
// the light that turns back behind it, up to three turns, as of sheets that let no light pass between fibres.
// Fibres here lie at random: both are solutions of the two-flux equations (Kubelka and Munk 1931) in the
// number of fibres, all turns included, and hair of finite depth over black or a matte ground. Light that
// arrives scattered comes evenly from half of the directions around the fibre, the side of the light or the
// side behind, and is scattered by the fibre's own N, averaged over that half.
//
// Angles in radians, colours linear RGB, 0 the azimuth back towards the light, as in marschner.h.

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

    double tilt() const;      ///< of all light
    double variance() const;  ///< in θ_h, of all light
};

/// Light inside a layer of hair lit from one side with 1, by the number of fibres that a ray meets on
/// average.
struct TwoFlux {
    Vec3d down = Vec3d::Zero();  ///< still away from the light; with what has met no fibre, exp(−before)
    Vec3d up = Vec3d::Zero();    ///< back towards it
    Vec3d groundDown = Vec3d::Zero();  ///< of what the ground has sent back
    Vec3d groundUp = Vec3d::Zero();
};
/// `before` fibres between the point and the light, `all` >= before from one side of the hair to the other,
/// where it lies on a ground of this albedo.
TwoFlux twoFlux(const Vec3d& forward, const Vec3d& backward, double before, double all,
                const Vec3d& ground = Vec3d::Zero());

class DualScattering {
  public:
    explicit DualScattering(const Marschner& model);
    /// Colours and intensities that would give more light than they get are taken as giving 0.98 of it.
    explicit DualScattering(const SadeghiParameters& model);

    /// N of all lobes, averaged over light from the half of directions around `phi` = 0: by φ as
    /// AzimuthalProfile::Grid.
    using Spread = std::array<std::array<float, AzimuthalProfile::kGridSize>, 3>;
    struct Row {
        AverageScattering average;
        Spread spread;
    };
    Row at(double thetaD) const;

    /// Of uniform light from everywhere, the mean over the inclinations.
    Vec3d meanAlbedo() const;

  private:
    const Marschner* marschner_ = nullptr;
    SadeghiParameters sadeghi_;
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
