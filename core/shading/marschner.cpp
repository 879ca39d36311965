// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/marschner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

void setScales(MarschnerParameters& parameters, double scaleTilt, double width) {
    const double ior = parameters.azimuthal.ior;
    parameters.tilt = {-scaleTilt, (ior - 1) * scaleTilt, (2 * ior - 1) * scaleTilt};
    parameters.width = {width, 0.5 * width, 2 * width};
}

FibreAngles fibreAngles(const Vec3d& tangent, const Vec3d& toLight, const Vec3d& toView) {
    const double sineIn = std::clamp(toLight.dot(tangent), -1.0, 1.0);
    const double sineOut = std::clamp(toView.dot(tangent), -1.0, 1.0);
    const Vec3d acrossIn = toLight - sineIn * tangent;
    const Vec3d acrossOut = toView - sineOut * tangent;
    const double lengths = acrossIn.norm() * acrossOut.norm();
    const double cosPhi = lengths > 1e-12 ? std::clamp(acrossIn.dot(acrossOut) / lengths, -1.0, 1.0) : 1;
    return {std::asin(sineIn), std::asin(sineOut), std::acos(cosPhi)};
}

Marschner::Marschner(const MarschnerParameters& parameters)
    : parameters_(parameters),
      lobes_{LongitudinalLobe(parameters.tilt[0], parameters.width[0]),
             LongitudinalLobe(parameters.tilt[1], parameters.width[1]),
             LongitudinalLobe(parameters.tilt[2], parameters.width[2])} {
    const double factor = energyFactor();
    for (std::size_t p = 0; p < 3; ++p) scale_[p] = factor * parameters.intensity[p];
}

double Marschner::energyFactor() const {
    // Without absorption and at intensity 1, whatever the colour: changing a colour must not change other
    // lobes.
    constexpr int kSteps = 60;
    constexpr double kStep = kPi / kSteps;
    AzimuthalParameters clear = parameters_.azimuthal;
    clear.absorption.setZero();
    clear.axisRatio = 1;
    clear.width = 1;                                           // neither this
    clear.causticWidth = 0;                                    // nor this changes energies
    std::array<std::array<double, 3>, kSteps + 1> energies{};  // by |θ_d| in half steps of θ
    for (std::size_t i = 0; i <= kSteps; ++i) {
        const AzimuthalProfile profile(clear, std::min(static_cast<double>(i) * kStep / 2, 0.4999 * kPi));
        for (const Lobe lobe : kLobes) energies[i][index(lobe)] = profile.energy(lobe).x();
    }
    double maximum = 1;
    for (int i = 0; i < kSteps; ++i) {
        const double in = (i + 0.5) * kStep - kPi / 2;
        double sum = 0;
        for (const Lobe lobe : kLobes) {
            // The mean over the lobe, so that the steps' own error divides out.
            double all = 0;
            double weighted = 0;
            for (int j = 0; j < kSteps; ++j) {
                const double out = (j + 0.5) * kStep - kPi / 2;
                const double ratio = std::cos(out) / std::cos(0.5 * (out - in));
                const double w = lobes_[index(lobe)].gauss(0.5 * (in + out)) *
                                 lobes_[index(lobe)].factorOut(out) * ratio * ratio;
                all += w;
                weighted += w * energies[static_cast<std::size_t>(std::abs(j - i))][index(lobe)];
            }
            sum += all > 0 ? weighted / all
                           : energies[static_cast<std::size_t>(std::abs(kSteps - 1 - 2 * i))][index(lobe)];
        }
        maximum = std::max(maximum, sum);
    }
    return 1 / maximum;
}

Vec3d Marschner::lobe(Lobe lobe, double thetaIn, double thetaOut, double phi) const {
    const double thetaD = 0.5 * (thetaOut - thetaIn);
    const double cosine = std::max(std::cos(thetaD), 1e-6);
    return longitudinal(lobe, thetaIn, thetaOut) / (cosine * cosine) * azimuthal(thetaD)(lobe, phi);
}

Vec3d Marschner::operator()(double thetaIn, double thetaOut, double phi) const {
    const double thetaD = 0.5 * (thetaOut - thetaIn);
    const double cosine = std::max(std::cos(thetaD), 1e-6);
    const AzimuthalProfile profile = azimuthal(thetaD);
    Vec3d sum = Vec3d::Zero();
    for (const Lobe lobe : kLobes) sum += longitudinal(lobe, thetaIn, thetaOut) * profile(lobe, phi);
    return sum / (cosine * cosine);
}

}  // namespace hairloom::shading
