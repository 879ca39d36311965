// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Light that a hair scatters, after Marschner et al. 2003 as Rünz 2012, section 5.2 has it; in double
// precision, the reference of the tables and shaders. Angles in radians. θ is measured from the plane across
// the fibre, positive towards its tip; φ between light and view, 0 is back towards the light. Colours are
// linear RGB.
//
// The thesis' slips that are mended here are in docs/errata.md.

#include "core/shading/azimuthal.h"
#include "core/shading/longitudinal.h"

namespace hairloom::shading {

inline constexpr double kDegree = 0.017453292519943295;

struct MarschnerParameters {
    AzimuthalParameters azimuthal;
    /// α_p and β_p of R, TT and TRT in θ_h. Negative tilts turn towards the root, as real scales turn R.
    std::array<double, 3> tilt{-2 * kDegree, 1 * kDegree, 3 * kDegree};
    std::array<double, 3> width{8.3 * kDegree, 4.15 * kDegree, 16.6 * kDegree};
    std::array<double, 3> intensity{1, 1, 1};  ///< factors on the lobes, >= 0; 1 is physical

    bool operator==(const MarschnerParameters&) const = default;
};

/// Tilts and widths of all lobes from those of R, β, β/2 and 2β (Marschner et al. 2003, Table 1). Scales that
/// rise towards the tip by α > 0 turn R by −α, TT by (η − 1)α and TRT by (2η − 1)α, as prisms and traced rays
/// do; the table's α/2 and 3α/2 have too little of TRT, Chiang et al. 2016 use 2α.
void setScales(MarschnerParameters& parameters, double scaleTilt, double width);

/// The angles that the models take, of three unit vectors; toLight and toView point away from the fibre, the
/// tangent from root to tip. φ is 0…π; 0 where light or view runs along the fibre.
struct FibreAngles {
    double thetaIn, thetaOut, phi;
};
FibreAngles fibreAngles(const Vec3d& tangent, const Vec3d& toLight, const Vec3d& toView);

class Marschner {
  public:
    explicit Marschner(const MarschnerParameters& parameters);

    const MarschnerParameters& parameters() const { return parameters_; }

    /// S (Eq. 33) per steradian: radiance towards the view = S cos θ_i times the irradiance perpendicular to
    /// the light. ∫ S cos θ_o dω_o is the share of light that comes out; with intensities and glint of 1
    /// never more than 1.
    Vec3d operator()(double thetaIn, double thetaOut, double phi) const;

    /// One lobe of S.
    Vec3d lobe(Lobe lobe, double thetaIn, double thetaOut, double phi) const;

    /// M_p with the intensity; N is AzimuthalProfile's.
    double longitudinal(Lobe lobe, double thetaIn, double thetaOut) const {
        return scale_[index(lobe)] * lobes_[index(lobe)](thetaIn, thetaOut);
    }
    const LongitudinalLobe& longitudinalLobe(Lobe lobe) const { return lobes_[index(lobe)]; }
    /// What M is multiplied with: the intensity and a common factor, 1 or a little less. Lobes of unequal
    /// widths see the border under unequal θ_d, so their energies could add up to more than 1; the factor
    /// takes that away.
    double scale(Lobe lobe) const { return scale_[index(lobe)]; }

    AzimuthalProfile azimuthal(double thetaD) const { return {parameters_.azimuthal, thetaD}; }

  private:
    double energyFactor() const;

    MarschnerParameters parameters_;
    std::array<LongitudinalLobe, 3> lobes_;
    std::array<double, 3> scale_{};
};

}  // namespace hairloom::shading
