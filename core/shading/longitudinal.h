// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace hairloom::shading {

/// M_p(θ_i, θ_o): the spread along the fibre of one path, a Gaussian of θ_h = (θ_i + θ_o)/2 around the tilt α
/// with the width β (Marschner et al. 2003; Rünz 2012, Eq. 34). The printed normalisation gives 2 over θ_o,
/// and the cosines around M in Eq. 33 and 49 change the energy once more. Here M = c(θ_i) d(θ_i) d(θ_o) g(θ_h
/// − α), such that
///
///     ∫ M(θ_i, θ_o) cos²θ_o / cos²θ_d dθ_o = 1  for every θ_i:
///
/// all light that takes the path comes out. d is that of the lobe without tilt, found by Sinkhorn's
/// iteration; there c is 1 and M symmetric, so the model is reciprocal. A tilt cannot be had with both: a
/// lobe that moves all light towards the root, backwards as forwards, would empty one end of an evenly lit
/// sphere. d is 1/√2 where the lobe is narrow.
class LongitudinalLobe {
  public:
    /// Radians; width is clamped to 0.5°…60°, tilt to ±30°.
    LongitudinalLobe(double tilt, double width);

    double operator()(double thetaIn, double thetaOut) const {
        return factorIn(thetaIn) * factorOut(thetaOut) * gauss(0.5 * (thetaIn + thetaOut));
    }
    double factorIn(double theta) const { return interpolate(in_, theta); }    ///< c(θ) d(θ)
    double factorOut(double theta) const { return interpolate(out_, theta); }  ///< d(θ)
    /// The unit Gaussian of θ_h around the tilt.
    double gauss(double thetaHalf) const;

    double tilt() const { return tilt_; }
    double width() const { return width_; }

  private:
    static double interpolate(const std::vector<double>& factors, double theta);

    double tilt_;
    double width_;
    std::vector<double> in_, out_;  ///< in the middles of equal steps over −π/2…π/2
};

}  // namespace hairloom::shading
