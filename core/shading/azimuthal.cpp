// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/azimuthal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/smooth_step.h"
#include "core/shading/cubic.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kQuadrature = 512;  // steps in γ from 0 to π/2, of the reference
constexpr int kEnergyQuadrature = 64;
constexpr int kTurns = 4;  // Gauss and Chebyshev nodes of the average over an elliptic fibre's turns

double gauss(double x, double deviation) {
    const double z = x / deviation;
    return std::exp(-0.5 * z * z);
}

/// Calls body(h, weight) for steps in γ over h = sin γ in 0…1; the weights add up to 1 = ½ ∫ dh.
template <class Body>
void overOffsets(int steps, const Body& body) {
    for (int i = 0; i < steps; ++i) {
        const double gamma = (i + 0.5) * (kPi / 2) / steps;
        body(std::sin(gamma), std::cos(gamma) * (kPi / 2) / steps);
    }
}

/// Eq. 39: the deflection of the ray with the offset h, without the turn by p π.
double deflection(int p, double h, double etaPrime) {
    return 2 * p * std::asin(std::clamp(h / etaPrime, -1.0, 1.0)) - 2 * std::asin(std::clamp(h, -1.0, 1.0));
}

double deflection(RootMethod method, int p, double h, double etaPrime) {
    if (method == RootMethod::Exact) return deflection(p, h, etaPrime);
    return CubicDeflection(p, etaPrime)(std::asin(h));
}

/// γ in low…high where the deflection (monotone there, with the values fLow and fHigh at the ends) is
/// `target`: Newton from `start`, kept inside by bisection. Returns false where there is none.
struct Bracket {
    double low, high, fLow, fHigh;
};
bool solveBracket(int p, double etaPrime, double target, const Bracket& bracket, double start,
                  double& gamma) {
    double low = bracket.low;
    double high = bracket.high;
    if ((bracket.fLow > target) == (bracket.fHigh > target)) return false;
    if (bracket.fLow > target) std::swap(low, high);
    gamma = start > std::min(low, high) && start < std::max(low, high) ? start : 0.5 * (low + high);
    for (int i = 0; i < 60; ++i) {
        const double s = std::sin(gamma);
        const double value = 2 * p * std::asin(std::clamp(s / etaPrime, -1.0, 1.0)) - 2 * gamma - target;
        (value < 0 ? low : high) = gamma;
        const double slope =
            2 * p * std::sqrt(1 - s * s) / std::sqrt(std::max(etaPrime * etaPrime - s * s, 1e-12)) - 2;
        double next = gamma - value / slope;
        if (!(next > std::min(low, high)) || !(next < std::max(low, high))) next = 0.5 * (low + high);
        const double moved = std::abs(next - gamma);
        gamma = next;
        if (moved < 1e-11) break;
    }
    return true;
}

struct Crossing {
    double gamma;
    double slope;  // dφ/dγ
};
struct Crossings {
    std::array<Crossing, 3> at{};
    int count = 0;
    void add(double gamma, double slope) { at[static_cast<std::size_t>(count++)] = {gamma, slope}; }
};

/// Eq. 41–44.
Crossings cubicCrossings(int p, double etaPrime, double target) {
    const CubicDeflection cubic(p, etaPrime);
    const RealRoots roots = solveCubic(cubic.a, cubic.b, -target);
    Crossings found;
    for (int i = 0; i < roots.count; ++i) {
        const double gamma = roots.x[static_cast<std::size_t>(i)];
        if (std::abs(gamma) <= kPi / 2) found.add(gamma, cubic.slope(gamma));
    }
    return found;
}

Crossings exactCrossings(int p, double etaPrime, double target) {
    Crossings found;
    const Crossings guesses = cubicCrossings(p, etaPrime, target);
    const auto solve = [&](const Bracket& bracket) {
        double start = bracket.low;  // outside: the middle is taken
        for (int i = 0; i < guesses.count; ++i) {
            const double guess = guesses.at[static_cast<std::size_t>(i)].gamma;
            if (guess > bracket.low && guess < bracket.high) start = guess;
        }
        double gamma = 0;
        if (!solveBracket(p, etaPrime, target, bracket, start, gamma)) return;
        const double s = std::sin(gamma);
        found.add(gamma,
                  2 * p * std::cos(gamma) / std::sqrt(std::max(etaPrime * etaPrime - s * s, 1e-12)) - 2);
    };
    const double atEdge = deflection(p, 1, etaPrime);
    if (p == 2 && etaPrime < 2) {
        // The deflection turns back where dφ/dh = 0.
        const double h = std::sqrt((4 - etaPrime * etaPrime) / 3);
        const double turn = std::asin(h);
        const double atTurn = deflection(2, h, etaPrime);
        solve({-kPi / 2, -turn, -atEdge, -atTurn});
        solve({-turn, turn, -atTurn, atTurn});
        solve({turn, kPi / 2, atTurn, atEdge});
    } else {
        solve({-kPi / 2, kPi / 2, -atEdge, atEdge});
    }
    return found;
}

/// φ_c: where dφ/dh = 0 of TRT. η' < 2.
double causticOf(RootMethod method, double etaPrime) {
    if (method == RootMethod::Cubic) {
        const CubicDeflection cubic(2, etaPrime);
        return std::abs(cubic(cubic.turn()));
    }
    return std::abs(deflection(2, std::sqrt((4 - etaPrime * etaPrime) / 3), etaPrime));
}

constexpr double kLeastIor = 1.01;  // of an elliptic fibre's narrow side

/// η*_1 and η*_2 of Eq. 47.
struct EllipticIors {
    double first, second;
    EllipticIors(double ior, double axisRatio)
        : first(2 * (ior - 1) * axisRatio * axisRatio - ior + 2),
          second(2 * (ior - 1) / (axisRatio * axisRatio) - ior + 2) {}
};

double smoothstep(double low, double high, double x) {
    return smoothStep(std::clamp((x - low) / std::max(high - low, 1e-6), 0.0, 1.0));
}

}  // namespace

CausticAzimuths causticAzimuths(double ior, double axisRatio) {
    const auto at = [](double eta) {
        return eta < 2 ? causticOf(RootMethod::Exact, std::max(eta, kLeastIor)) : 0.0;
    };
    const EllipticIors eta(ior, axisRatio);
    const auto [least, greatest] = std::minmax({at(eta.first), at(eta.second)});
    return {at(ior), least, greatest};
}

double wrapAngle(double angle) {
    return angle - 2 * kPi * std::round(angle / (2 * kPi));
}

double wrappedGauss(double angle, double deviation) {
    const double x = wrapAngle(angle);
    const int turns = deviation > 1 ? 3 : 1;
    double sum = 0;
    for (int k = -turns; k <= turns; ++k) sum += gauss(x + 2 * kPi * k, deviation);
    return sum / (deviation * std::sqrt(2 * kPi));
}

AzimuthalProfile::AzimuthalProfile(const AzimuthalParameters& parameters, double thetaD)
    : parameters_(parameters), thetaD_(thetaD) {
    if (!isRough()) {
        parameters_.width = 0;
        parameters_.causticWidth = std::max(parameters_.causticWidth, kMinCausticWidth);
    }
    circle_ = {makeSection(parameters_.ior)};
    if (parameters_.axisRatio == 1) {
        trt_ = circle_;
        return;
    }
    const EllipticIors eta(parameters_.ior, parameters_.axisRatio);
    const double energyOfCircle = energy(Lobe::TRT).sum();
    for (int k = 0; k < kTurns; ++k) {
        const double cos2Phi = std::cos((k + 0.5) * kPi / kTurns);
        const double ior =
            std::max(0.5 * (eta.first + eta.second + cos2Phi * (eta.first - eta.second)), kLeastIor);
        trt_.push_back(makeSection(ior));
        double energyHere = 0;
        overOffsets(kEnergyQuadrature, [&](double h, double weight) {
            energyHere += weight * attenuation(trt_.back().optics.at(h), 2).sum();
        });
        // An index that stands for a shape changes where light goes, not how much there is.
        trt_.back().share = energyOfCircle / std::max(energyHere, 1e-30) / kTurns;
    }
}

AzimuthalProfile::Section AzimuthalProfile::makeSection(double ior) const {
    Section section{CrossSection(ior, thetaD_, parameters_.absorption)};
    if (parameters_.causticWidth <= 0) return section;
    const double etaPrime = section.optics.indices().perpendicular;
    if (etaPrime < 2) {
        section.causticPhi = causticOf(parameters_.roots, etaPrime);
        section.fade = 1;
    } else {
        section.fade = 1 - smoothstep(2, 2 + parameters_.causticFade, etaPrime);
    }
    if (section.fade == 0) return section;
    // Marschner et al. estimate the energy of a caustic from its curvature and cap it (Δh_M); here it is what
    // the fade takes away.
    overOffsets(kEnergyQuadrature, [&](double h, double weight) {
        const double lost = 1 - kept(section, deflection(parameters_.roots, 2, h, etaPrime));
        section.removed += weight * lost * attenuation(section.optics.at(h), 2);
    });
    return section;
}

double AzimuthalProfile::kept(const Section& section, double phi) const {
    if (section.fade == 0) return 1;
    const double width = parameters_.causticWidth;
    return (1 - section.fade * gauss(wrapAngle(phi - section.causticPhi), width)) *
           (1 - section.fade * gauss(wrapAngle(phi + section.causticPhi), width));
}

Vec3d AzimuthalProfile::smooth(const Section& section, Lobe lobe, double phi) const {
    const int p = order(lobe);
    const double target = wrapAngle(phi - p * kPi);
    if (lobe == Lobe::R) {
        return 0.25 * std::cos(target / 2) * attenuation(section.optics.at(std::sin(-target / 2)), 0);
    }
    const double etaPrime = section.optics.indices().perpendicular;
    const Crossings crossings = parameters_.roots == RootMethod::Exact ? exactCrossings(p, etaPrime, target)
                                                                       : cubicCrossings(p, etaPrime, target);
    Vec3d sum = Vec3d::Zero();
    for (int i = 0; i < crossings.count; ++i) {
        const auto [gamma, slope] = crossings.at[static_cast<std::size_t>(i)];
        // Eq. 38 with dφ/dh = (dφ/dγ) / cos γ.
        const double density = 0.5 * std::cos(gamma) / std::max(std::abs(slope), 1e-6);
        sum += density * attenuation(section.optics.at(std::sin(gamma)), p);
    }
    return sum;
}

Vec3d AzimuthalProfile::causticGauss(const Section& section, double phi) const {
    if (section.fade == 0) return Vec3d::Zero();
    const double width = std::hypot(parameters_.causticWidth, parameters_.width);
    const double shape =
        wrappedGauss(phi - section.causticPhi, width) + wrappedGauss(phi + section.causticPhi, width);
    return 0.5 * parameters_.glint * shape * section.removed;
}

Vec3d AzimuthalProfile::rough(const Section& section, Lobe lobe, double phi) const {
    const int p = order(lobe);
    const double etaPrime = section.optics.indices().perpendicular;
    Vec3d sum = Vec3d::Zero();
    overOffsets(kQuadrature, [&](double h, double weight) {
        const double turned = deflection(parameters_.roots, p, h, etaPrime);
        const double shape = 0.5 * (wrappedGauss(phi - p * kPi - turned, parameters_.width) +
                                    wrappedGauss(phi - p * kPi + turned, parameters_.width));
        const double share = lobe == Lobe::TRT ? kept(section, turned) : 1;
        sum += weight * share * shape * attenuation(section.optics.at(h), p);
    });
    return sum;
}

Vec3d AzimuthalProfile::operator()(Lobe lobe, double phi) const {
    Vec3d sum = Vec3d::Zero();
    for (const Section& section : sections(lobe)) {
        Vec3d n = isRough() ? rough(section, lobe, phi) : smooth(section, lobe, phi);
        if (lobe == Lobe::TRT) {
            if (!isRough()) n *= kept(section, phi);
            n += causticGauss(section, phi);
        }
        sum += section.share * n;
    }
    return sum;
}

Vec3d AzimuthalProfile::energy(Lobe lobe) const {
    Vec3d sum = Vec3d::Zero();
    overOffsets(kEnergyQuadrature, [&](double h, double weight) {
        sum += weight * attenuation(circle_.front().optics.at(h), order(lobe));
    });
    return sum;
}

Vec3d AzimuthalProfile::energyBeyond() const {
    Vec3d sum = Vec3d::Zero();
    overOffsets(kEnergyQuadrature, [&](double h, double weight) {
        sum += weight * attenuationFrom(circle_.front().optics.at(h), 3);
    });
    return sum;
}

}  // namespace hairloom::shading
