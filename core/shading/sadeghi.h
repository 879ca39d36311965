// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The artist-friendly model of Sadeghi et al. 2010 as Rünz 2012, section 5.3 has it: lobes that can be moved,
// widened and coloured one by one, without Fresnel terms. As published it may send out more light than it
// gets, by intention: a wider lobe stays as bright. Angles as in marschner.h; colours linear RGB.

#include "core/shading/marschner.h"

namespace hairloom::shading {

struct SadeghiLobe {
    Vec3d colour = Vec3d::Ones();  ///< C_p, 0…1
    Vec3d tint = Vec3d::Ones();    ///< factor on the colour, which absorption does not change
    double intensity = 0;          ///< I_p, >= 0
    double shift = 0;              ///< α_p in θ_h
    /// β_p in θ_h, > 0. The Gaussians are exp(−π ν²/β²), of height 1 and area β; their deviation is β/√(2π).
    /// The thesis hands β² to Eq. 52 and squares it again there.
    double width = 0.3;

    bool operator==(const SadeghiLobe&) const = default;
    Vec3d light() const { return intensity * colour.cwiseProduct(tint); }
};

struct SadeghiParameters {
    SadeghiLobe r, tt, trt;
    double ttAzimuthalWidth = 1;       ///< φ_TT, as the longitudinal widths
    double glintIntensity = 0.5;       ///< I_g, relative to TRT, >= 0
    double glintWidth = 10 * kDegree;  ///< azimuthal
    /// Glints lie at ± an angle in this range, another one for each strand (thesis, section 5.3).
    double glintNear = 30 * kDegree, glintFar = 45 * kDegree;
    bool bounded = true;  ///< as SadeghiLongitudinal says; false: as published

    bool operator==(const SadeghiParameters&) const = default;
    const SadeghiLobe& lobe(Lobe lobe) const { return lobe == Lobe::R ? r : lobe == Lobe::TT ? tt : trt; }
};

/// exp(−π ν²/width²).
double unitHeightGauss(double x, double width);

/// M'_p of Eq. 52, with θ_h for the printed θ_d. Where the parameters are bounded it is that of
/// LongitudinalLobe times the energy that the printed one has across the fibre, so that a lobe sends out the
/// same at any inclination; and all lobes are scaled alike where they would send out more than all light in
/// their brightest channel, or towards a grazing view, where a tilt gathers light.
class SadeghiLongitudinal {
  public:
    explicit SadeghiLongitudinal(const SadeghiParameters& parameters)
        : SadeghiLongitudinal(parameters, parameters) {}
    /// Bounded for the brightest hair that the same table serves.
    SadeghiLongitudinal(const SadeghiParameters& parameters, const SadeghiParameters& brightest);

    double operator()(Lobe lobe, double thetaIn, double thetaOut) const {
        return factorIn(lobe, thetaIn) * factorOut(lobe, thetaOut) * gauss(lobe, 0.5 * (thetaIn + thetaOut));
    }
    double factorIn(Lobe lobe, double theta) const;
    double factorOut(Lobe lobe, double theta) const;
    double gauss(Lobe lobe, double thetaHalf) const;  ///< around the lobe's shift
    /// ∫ M'_p cos²θ_o / cos²θ_d dθ_o of light across the fibre.
    double energy(Lobe lobe) const { return energy_[index(lobe)]; }

  private:
    double towardsView(double thetaOut) const;

    SadeghiParameters parameters_;
    std::vector<LongitudinalLobe> lobes_;  ///< where it is bounded
    std::array<double, 3> energy_{};
    std::vector<double> views_;  ///< factors by θ_o, in the middles of equal steps over −π/2…π/2
};
/// N'_p of Eq. 53; `glint` 0…1 is the strand's place between glintNear and glintFar.
double sadeghiAzimuthal(const SadeghiParameters& parameters, Lobe lobe, double phi, double glint);

/// S' of Eq. 51, used as S.
Vec3d evaluate(const SadeghiParameters& parameters, double thetaIn, double thetaOut, double phi,
               double glint);
/// The same where many are asked for.
Vec3d evaluate(const SadeghiLongitudinal& longitudinal, const SadeghiParameters& parameters, double thetaIn,
               double thetaOut, double phi, double glint);

/// The controls at which the lobes have place, width, colour and energy of Marschner's for light across the
/// fibre: where an artist starts from. A fifth of TRT's energy goes into the glints.
SadeghiParameters sadeghiLike(const Marschner& model);

/// ½ ∫ A_p dh across the fibre of light that is absorbed, TT and TRT: what colours those two lobes.
struct TransmittedEnergies {
    Vec3d tt, trt;
};
TransmittedEnergies transmittedEnergies(const AzimuthalParameters& fibre, const Vec3d& absorption);

/// The controls for the same hair of another absorption: TT and TRT get its colours and change in intensity
/// as the energies do. `fibre` has the absorption at which the intensities of `parameters` hold.
SadeghiParameters withAbsorption(const SadeghiParameters& parameters, const AzimuthalParameters& fibre,
                                 const Vec3d& absorption);

}  // namespace hairloom::shading
