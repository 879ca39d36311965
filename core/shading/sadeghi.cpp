// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/sadeghi.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWidthOfDeviation = 2.5066282746310002;  // √(2π)
constexpr double kGlintShare = 0.2;

/// The colour whose largest channel is 1, and that channel.
SadeghiLobe lobeOf(const Vec3d& energy, double area, double shift, double deviation) {
    SadeghiLobe lobe;
    const double maximum = energy.maxCoeff();
    if (maximum > 0) lobe.colour = energy / maximum;
    lobe.shift = shift;
    lobe.width = kWidthOfDeviation * deviation;
    // θ_h is half of θ_o: the longitudinal area over θ_o is twice the width.
    lobe.intensity = maximum / (2 * lobe.width * area);
    return lobe;
}

/// ∫ N'_p dφ, at most.
double azimuthalArea(const SadeghiParameters& parameters, Lobe lobe) {
    const double round = 4;  // ∫ cos(φ/2) dφ
    if (lobe == Lobe::R) return round;
    if (lobe == Lobe::TT) return parameters.ttAzimuthalWidth;
    return round + 2 * parameters.glintIntensity * parameters.glintWidth;
}

constexpr std::size_t kViews = 128;
constexpr double kViewStep = kPi / kViews;

/// ∫ M cos²θ_i / cos²θ_d dθ_i: of even light from around.
double lightFromAround(const LongitudinalLobe& lobe, double thetaOut) {
    const double reach = std::min(12 * lobe.width(), kPi);
    const int steps = 96;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double thetaIn = 2 * lobe.tilt() - thetaOut + reach * ((i + 0.5) / steps * 2 - 1);
        if (std::abs(thetaIn) >= kPi / 2) continue;
        const double ratio = std::cos(thetaIn) / std::cos(0.5 * (thetaOut - thetaIn));
        sum += lobe(thetaIn, thetaOut) * ratio * ratio * 2 * reach / steps;
    }
    return sum;
}

}  // namespace

double unitHeightGauss(double x, double width) {
    const double z = x / width;
    return std::exp(-kPi * z * z);
}

SadeghiLongitudinal::SadeghiLongitudinal(const SadeghiParameters& parameters,
                                         const SadeghiParameters& brightest)
    : parameters_(parameters) {
    // θ_h is half of θ_o: the area over θ_o is twice the width.
    for (const Lobe lobe : kLobes) energy_[index(lobe)] = 2 * parameters.lobe(lobe).width;
    if (!parameters.bounded) return;
    std::array<Vec3d, 3> shares;
    Vec3d all = Vec3d::Zero();
    for (const Lobe lobe : kLobes) {
        const SadeghiLobe& l = parameters.lobe(lobe);
        lobes_.emplace_back(l.shift, l.width / kWidthOfDeviation);
        shares[index(lobe)] =
            energy_[index(lobe)] * azimuthalArea(brightest, lobe) * brightest.lobe(lobe).light();
        all += shares[index(lobe)];
    }
    const double scale = 1 / std::max(1.0, all.maxCoeff());
    for (double& energy : energy_) energy *= scale;
    for (std::size_t i = 0; i < kViews; ++i) {
        const double thetaOut = (static_cast<double>(i) + 0.5) * kViewStep - kPi / 2;
        Vec3d light = Vec3d::Zero();
        for (const Lobe lobe : kLobes)
            light += scale * lightFromAround(lobes_[index(lobe)], thetaOut) * shares[index(lobe)];
        views_.push_back(1 / std::max(1.0, light.maxCoeff()));
    }
}

double SadeghiLongitudinal::towardsView(double thetaOut) const {
    const double x = std::clamp((thetaOut + kPi / 2) / kViewStep - 0.5, 0.0, static_cast<double>(kViews - 1));
    const auto i = std::min(static_cast<std::size_t>(x), kViews - 2);
    const double t = x - static_cast<double>(i);
    return (1 - t) * views_[i] + t * views_[i + 1];
}

double SadeghiLongitudinal::factorIn(Lobe lobe, double theta) const {
    return lobes_.empty() ? 1 : energy_[index(lobe)] * lobes_[index(lobe)].factorIn(theta);
}

double SadeghiLongitudinal::factorOut(Lobe lobe, double theta) const {
    return lobes_.empty() ? 1 : lobes_[index(lobe)].factorOut(theta) * towardsView(theta);
}

double SadeghiLongitudinal::gauss(Lobe lobe, double thetaHalf) const {
    const SadeghiLobe& l = parameters_.lobe(lobe);
    return lobes_.empty() ? unitHeightGauss(thetaHalf - l.shift, l.width)
                          : lobes_[index(lobe)].gauss(thetaHalf);
}

double sadeghiAzimuthal(const SadeghiParameters& parameters, Lobe lobe, double phi, double glint) {
    const double turned = std::abs(wrapAngle(phi));
    if (lobe == Lobe::TT) return unitHeightGauss(kPi - turned, parameters.ttAzimuthalWidth);
    const double round = std::cos(0.5 * turned);
    if (lobe == Lobe::R) return round;
    const double place = parameters.glintNear + glint * (parameters.glintFar - parameters.glintNear);
    return round + parameters.glintIntensity * unitHeightGauss(place - turned, parameters.glintWidth);
}

Vec3d evaluate(const SadeghiParameters& parameters, double thetaIn, double thetaOut, double phi,
               double glint) {
    return evaluate(SadeghiLongitudinal(parameters), parameters, thetaIn, thetaOut, phi, glint);
}

Vec3d evaluate(const SadeghiLongitudinal& longitudinal, const SadeghiParameters& parameters, double thetaIn,
               double thetaOut, double phi, double glint) {
    const double cosine = std::max(std::cos(0.5 * (thetaOut - thetaIn)), 1e-6);
    Vec3d sum = Vec3d::Zero();
    for (const Lobe lobe : kLobes) {
        const SadeghiLobe& l = parameters.lobe(lobe);
        sum += longitudinal(lobe, thetaIn, thetaOut) * sadeghiAzimuthal(parameters, lobe, phi, glint) *
               l.light();
    }
    return sum / (cosine * cosine);
}

SadeghiParameters sadeghiLike(const Marschner& model) {
    const MarschnerParameters& m = model.parameters();
    const AzimuthalProfile across = model.azimuthal(0);
    const AzimuthalProfile::Grid grid = across.grid();
    double all = 0;
    double variance = 0;
    for (std::size_t i = 0; i < grid.tt[0].size(); ++i) {
        const double fromBack =
            kPi * (1 - static_cast<double>(i) / static_cast<double>(grid.tt[0].size() - 1));
        const double n = static_cast<double>(grid.tt[0][i] + grid.tt[1][i] + grid.tt[2][i]);
        all += n;
        variance += n * fromBack * fromBack;
    }
    SadeghiParameters s;
    s.ttAzimuthalWidth = kWidthOfDeviation * (all > 0 ? std::sqrt(variance / all) : 0.5);
    const double roundArea = 4;  // ∫ cos(φ/2) dφ
    s.glintIntensity = kGlintShare / (1 - kGlintShare) * roundArea / (2 * s.glintWidth);
    const auto energy = [&](Lobe lobe) { return Vec3d(m.intensity[index(lobe)] * across.energy(lobe)); };
    s.r = lobeOf(energy(Lobe::R), roundArea, m.tilt[0], m.width[0]);
    s.tt = lobeOf(energy(Lobe::TT), s.ttAzimuthalWidth, m.tilt[1], m.width[1]);
    s.trt = lobeOf(energy(Lobe::TRT), roundArea / (1 - kGlintShare), m.tilt[2], m.width[2]);
    return s;
}

TransmittedEnergies transmittedEnergies(const AzimuthalParameters& fibre, const Vec3d& absorption) {
    AzimuthalParameters other = fibre;
    other.absorption = absorption;
    const AzimuthalProfile across(other, 0);
    return {across.energy(Lobe::TT), across.energy(Lobe::TRT)};
}

SadeghiParameters withAbsorption(const SadeghiParameters& parameters, const AzimuthalParameters& fibre,
                                 const Vec3d& absorption) {
    const TransmittedEnergies before = transmittedEnergies(fibre, fibre.absorption);
    const TransmittedEnergies now = transmittedEnergies(fibre, absorption);
    SadeghiParameters result = parameters;
    const auto change = [](SadeghiLobe& lobe, const Vec3d& from, const Vec3d& to) {
        const double maximum = to.maxCoeff();
        if (!(maximum > 0) || !(from.maxCoeff() > 0)) {
            lobe.intensity = 0;
            return;
        }
        lobe.intensity *= maximum / from.maxCoeff();
        lobe.colour = to / maximum;
    };
    change(result.tt, before.tt, now.tt);
    change(result.trt, before.trt, now.trt);
    return result;
}

}  // namespace hairloom::shading
