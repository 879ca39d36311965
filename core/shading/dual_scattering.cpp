// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/dual_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kLast = AzimuthalProfile::kGridSize - 1;
constexpr double kStep = kPi / static_cast<double>(kLast);
constexpr double kMostAlbedo = 0.98;

using Channels = std::array<std::array<float, AzimuthalProfile::kGridSize>, 3>;
using LobeRows = std::array<Channels, 3>;

struct LobeShape {
    double tilt, deviation;
};

/// ∫ N w dφ over the whole circle, w linear in |φ|: 1 − |φ|/π and |φ|/π are the chances that light, from
/// anywhere within half of the directions, leaves within that half or the other.
struct Halves {
    Vec3d back = Vec3d::Zero(), forth = Vec3d::Zero();
};
Halves halves(const Channels& n) {
    Halves result;
    for (std::size_t i = 0; i <= kLast; ++i) {
        const double weight = (i == 0 || i == kLast ? 1 : 2) * kStep;
        const double away = static_cast<double>(i) / static_cast<double>(kLast);
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = weight * static_cast<double>(n[c][i]);
            result.back[static_cast<int>(c)] += value * (1 - away);
            result.forth[static_cast<int>(c)] += value * away;
        }
    }
    return result;
}

AverageScattering averageOf(const LobeRows& rows, const std::array<LobeShape, 3>& shapes) {
    AverageScattering a;
    for (const Lobe lobe : kLobes) {
        const Halves h = halves(rows[index(lobe)]);
        const auto& [tilt, deviation] = shapes[index(lobe)];
        a.forward += h.forth;
        a.backward += h.back;
        a.forwardVariances += h.forth * (deviation * deviation);
        a.backwardVariances += h.back * (deviation * deviation);
        a.forwardTilts += h.forth * tilt;
        a.backwardTilts += h.back * tilt;
    }
    const double forth = std::max(a.forward.sum(), 1e-12), back = std::max(a.backward.sum(), 1e-12);
    a.forwardVariance = a.forwardVariances.sum() / forth;
    a.backwardVariance = a.backwardVariances.sum() / back;
    a.forwardTilt = a.forwardTilts.sum() / forth;
    a.backwardTilt = a.backwardTilts.sum() / back;
    return a;
}

/// The mean over ± 90 degrees around each azimuth.
DualScattering::Spread spreadOf(const LobeRows& rows) {
    DualScattering::Spread spread{};
    constexpr std::size_t kQuarter = kLast / 2;
    static_assert(kLast % 2 == 0);
    for (std::size_t c = 0; c < 3; ++c) {
        std::array<double, 2 * kLast + 2>
            sums{};  // sums[i]: of the first i steps' means, φ from −90 degrees on
        const auto n = [&](std::size_t step) {  // `step` counts from φ = −90 degrees
            const std::size_t from0 = step < kQuarter ? kQuarter - step : step - kQuarter;
            const std::size_t i = from0 <= kLast ? from0 : 2 * kLast - from0;
            return static_cast<double>(rows[0][c][i] + rows[1][c][i] + rows[2][c][i]);
        };
        for (std::size_t i = 0; i <= 2 * kLast; ++i) sums[i + 1] = sums[i] + 0.5 * (n(i) + n(i + 1));
        for (std::size_t i = 0; i <= kLast; ++i) {
            spread[c][i] = static_cast<float>((sums[i + kLast] - sums[i]) / static_cast<double>(kLast));
        }
    }
    return spread;
}

}  // namespace

double AverageScattering::tilt() const {
    const double forth = forward.sum(), back = backward.sum();
    return (forth * forwardTilt + back * backwardTilt) / std::max(forth + back, 1e-12);
}

double AverageScattering::variance() const {
    const double forth = forward.sum(), back = backward.sum();
    return (forth * forwardVariance + back * backwardVariance) / std::max(forth + back, 1e-12);
}

TwoFlux twoFlux(const Vec3d& forward, const Vec3d& backward, double before, double all, const Vec3d& ground) {
    TwoFlux flux;
    const double behind = std::max(all - before, 0.0);
    for (int c = 0; c < 3; ++c) {
        // d down/dn = −(1 − ā_f) down + ā_b up, and the reverse for up, which is 0 at the far side.
        const double lost = 1 - forward[c];
        const double rate = std::sqrt(std::max(lost * lost - backward[c] * backward[c], 1e-6));
        const double returned = backward[c] / (lost + rate);  // of hair without end
        const double falling = std::exp(-rate * before);
        const double back = falling * std::exp(-2 * rate * behind);
        const double turns = 1 - returned * returned * std::exp(-2 * rate * (before + behind));
        flux.down[c] = (falling - returned * returned * back) / turns;
        flux.up[c] = returned * (falling - back) / turns;
        // What the ground gets and the hair above returns to it, again and again; then as if lit from there.
        const double deep = std::exp(-rate * (before + behind));
        const double reached = (1 - returned * returned) * deep / turns;
        const double kept = returned * (1 - deep * deep) / turns;
        const double sent = ground[c] * reached / (1 - ground[c] * kept);
        const double rising = std::exp(-rate * behind);
        flux.groundUp[c] = sent * (rising - returned * returned * deep * falling) / turns;
        flux.groundDown[c] = sent * returned * (rising - deep * falling) / turns;
    }
    return flux;
}

DualScattering::DualScattering(const Marschner& model) : marschner_(&model) {}
DualScattering::DualScattering(const SadeghiParameters& model) : sadeghi_(model) {}

DualScattering::Row DualScattering::at(double thetaD) const {
    LobeRows rows{};
    std::array<LobeShape, 3> shapes{};
    if (marschner_ != nullptr) {
        const AzimuthalProfile::Grid grid = marschner_->azimuthal(thetaD).grid();
        for (const Lobe lobe : kLobes) {
            const auto scale = static_cast<float>(marschner_->scale(lobe));
            const LongitudinalLobe& l = marschner_->longitudinalLobe(lobe);
            shapes[index(lobe)] = {l.tilt(), l.width()};
            for (std::size_t c = 0; c < 3; ++c) {
                const auto& from = lobe == Lobe::R ? grid.r : lobe == Lobe::TT ? grid.tt[c] : grid.trt[c];
                for (std::size_t i = 0; i <= kLast; ++i) rows[index(lobe)][c][i] = scale * from[i];
            }
        }
    } else {
        for (const Lobe lobe : kLobes) {
            const SadeghiLobe& l = sadeghi_.lobe(lobe);
            shapes[index(lobe)] = {l.shift, l.width / std::sqrt(2 * kPi)};
            for (std::size_t i = 0; i <= kLast; ++i) {
                // The area of M' over θ_o is twice the width.
                const double n =
                    2 * l.width * sadeghiAzimuthal(sadeghi_, lobe, static_cast<double>(i) * kStep, 0.5);
                const Vec3d light = l.light();
                for (std::size_t c = 0; c < 3; ++c) {
                    rows[index(lobe)][c][i] = static_cast<float>(n * light[static_cast<int>(c)]);
                }
            }
        }
    }
    Row row{averageOf(rows, shapes), spreadOf(rows)};
    for (int c = 0; c < 3; ++c) {
        const double albedo = row.average.forward[c] + row.average.backward[c];
        if (albedo <= kMostAlbedo) continue;
        row.average.forward[c] *= kMostAlbedo / albedo;
        row.average.backward[c] *= kMostAlbedo / albedo;
        for (float& n : row.spread[static_cast<std::size_t>(c)])
            n *= static_cast<float>(kMostAlbedo / albedo);
    }
    return row;
}

Vec3d DualScattering::meanAlbedo() const {
    constexpr int kSteps = 12;
    Vec3d sum = Vec3d::Zero();
    double weights = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double theta = (i + 0.5) * kPi / 2 / kSteps;
        const AverageScattering a = at(theta).average;
        // Across the fibre's length, and the ring of directions at θ.
        const double weight = std::cos(theta) * std::cos(theta);
        sum += weight * (a.forward + a.backward);
        weights += weight;
    }
    return sum / weights;
}

double scatteringsOf(double x) {
    return x < 1e-3 ? 1 + 0.5 * x : x / (1 - std::exp(-x));
}

double spreadLongitudinal(double tilt, double variance, double thetaIn, double thetaOut) {
    const LongitudinalLobe lobe(0, std::sqrt(variance));
    return lobe.factorIn(thetaIn) * lobe.factorOut(thetaOut) * lobe.gauss(0.5 * (thetaIn + thetaOut) - tilt);
}

Vec3d multipleScattering(const DualScattering::Row& row, double thetaIn, double thetaOut, double phi,
                         double before, double all, const Vec3d& ground) {
    const AverageScattering& a = row.average;
    const TwoFlux flux = twoFlux(a.forward, a.backward, before, all, ground);
    const Vec3d down = (flux.down - Vec3d::Constant(std::exp(-before))).cwiseMax(0.0);
    const double cosine = std::max(std::cos(0.5 * (thetaOut - thetaIn)), 1e-6);
    const double factor = std::cos(thetaIn) / (cosine * cosine);
    const auto spread = [&](double azimuth) {
        const double x = std::abs(wrapAngle(azimuth)) / kStep;
        const auto i = std::min(static_cast<std::size_t>(x), kLast - 1);
        const double t = x - static_cast<double>(i);
        Vec3d n;
        for (std::size_t c = 0; c < 3; ++c) {
            n[static_cast<int>(c)] = (1 - t) * static_cast<double>(row.spread[c][i]) +
                                     t * static_cast<double>(row.spread[c][i + 1]);
        }
        return n;
    };
    // Each scattering adds its variance and its tilt (Zinke et al. 2008). Light from behind has
    // turned once more and, near the surface, passed two fibres more on its way.
    const double passed = scatteringsOf(before * a.forward.mean());
    const double downM = spreadLongitudinal(a.tilt() + passed * a.forwardTilt,
                                            a.variance() + passed * a.forwardVariance, thetaIn, thetaOut);
    const double upM = spreadLongitudinal(
        a.tilt() + (passed + 1) * a.forwardTilt + a.backwardTilt,
        a.variance() + (passed + 1) * a.forwardVariance + a.backwardVariance, thetaIn, thetaOut);
    // Light from the ground has no memory of the light's inclination: 2 / π N towards all directions. Even
    // light in a half space meets π / 2 times the fibres that light straight through does.
    const double evenM = cosine * cosine;
    return factor * ((downM * down + evenM * flux.groundDown).cwiseProduct(spread(phi)) +
                     (upM * flux.up + evenM * flux.groundUp).cwiseProduct(spread(phi + kPi)));
}

}  // namespace hairloom::shading
