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
constexpr double kMaxAlbedo = 0.995;

using Channels = std::array<std::array<float, AzimuthalProfile::kGridSize>, 3>;
using LobeRows = std::array<Channels, 3>;
constexpr double kMinLoss =
    1e-3;  // of diffuse light at a fibre: what solves the equations in single precision

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

/// ∫ N cos mφ over the whole circle.
Vec3d momentOf(const Channels& n, int m) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i <= kLast; ++i) {
        const double weight =
            (i == 0 || i == kLast ? 1 : 2) * kStep * std::cos(m * static_cast<double>(i) * kStep);
        for (std::size_t c = 0; c < 3; ++c) sum[static_cast<int>(c)] += weight * static_cast<double>(n[c][i]);
    }
    return sum;
}

DualScattering::Profile profileOf(const LobeRows& rows) {
    DualScattering::Profile profile{};
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i <= kLast; ++i)
            profile[c][i] = rows[0][c][i] + rows[1][c][i] + rows[2][c][i];
    }
    return profile;
}

/// Of one channel.
struct Lit {
    double fluence = 0, flux = 0, onward = 0;
};

/// P1 in the plane across the fibres. With τ the depth in scaled fibres, φ the fluence and J the flux of
/// diffuse light, ω and g of what is not scattered straight on:
///     J' = −(1 − ω) φ + ω b,  φ' = −2 (1 − ωg) J + 2 ωg b,  b = e^−τ,
/// and no diffuse light comes in from above: φ/π + J/2 = 0.
class Layer {
  public:
    Layer(double albedo, double first, double second, double before, double all, double ground)
        : scale_(1 - std::max(second, 0.0)),
          ground_(ground),
          at_(scale_ * before),
          depth_(scale_ * std::max(all, before)) {
        const double omega = (albedo - std::max(second, 0.0)) / scale_;
        asymmetric_ = (first - std::max(second, 0.0)) / scale_;
        lost_ = std::max(1 - omega, kMinLoss);
        omega_ = 1 - lost_;
        // The beam must not fade exactly as diffuse light does.
        turned_ = 2 * (1 - asymmetric_);
        if (std::abs(lost_ * turned_ - 1) < kResonance) turned_ = (1 + kResonance) / lost_;
        rate_ = std::sqrt(lost_ * turned_);
        slope_ = std::sqrt(lost_ / turned_);
    }

    Lit beam() const {
        const double source = 2 * asymmetric_;
        const double y = (turned_ * omega_ + source) / (rate_ * rate_ - 1), x = (source + y) / turned_;
        const double end = std::exp(-depth_), here = std::exp(-at_);
        const double in = y / kPi + x / 2, out = y / kPi - x / 2;
        const Lit own = diffuse(-in, end * (ground_ * (1 + in) - out));
        return {own.fluence + y * here, own.flux + x * here, here};
    }

  private:
    static constexpr double kResonance = 0.01;

    /// `top`, `bottom`: what has to come in at the two sides.
    Lit diffuse(double top, double bottom) const {
        const double t = 1 / kPi + slope_ / 2, u = 1 / kPi - slope_ / 2;
        const double deep = std::exp(-rate_ * depth_);
        const double fromTop = deep * (u - ground_ * t), fromBottom = t - ground_ * u;
        const double determinant = t * fromBottom - deep * u * fromTop;
        const double falling = (top * fromBottom - deep * u * bottom) / determinant * std::exp(-rate_ * at_);
        const double rising = (t * bottom - fromTop * top) / determinant * std::exp(-rate_ * (depth_ - at_));
        return {falling + rising, slope_ * (falling - rising), 0};
    }

    double scale_, ground_, at_, depth_;
    double omega_ = 0, asymmetric_ = 0, lost_ = 0, turned_ = 0, rate_ = 0, slope_ = 0;
};

}  // namespace

double AverageScattering::tilt() const {
    const double forth = forward.sum(), back = backward.sum();
    return (forth * forwardTilt + back * backwardTilt) / std::max(forth + back, 1e-12);
}

double AverageScattering::variance() const {
    const double forth = forward.sum(), back = backward.sum();
    return (forth * forwardVariance + back * backwardVariance) / std::max(forth + back, 1e-12);
}

LayerLight beamInLayer(const AverageScattering& fibre, double before, double all, const Vec3d& ground) {
    LayerLight light;
    const Vec3d albedo = fibre.forward + fibre.backward;
    for (int c = 0; c < 3; ++c) {
        const Lit lit = Layer(albedo[c], fibre.first[c], fibre.second[c], before, all, ground[c]).beam();
        light.fluence[c] = lit.fluence;
        light.flux[c] = lit.flux;
        light.onward[c] = lit.onward;
    }
    return light;
}

DualScattering::DualScattering(const Marschner& model) : marschner_(&model) {}
DualScattering::DualScattering(const SadeghiParameters& model, SadeghiLongitudinal longitudinal)
    : sadeghi_(model), longitudinal_(std::move(longitudinal)) {}

struct DualScattering::Lobes {
    LobeRows rows{};
    std::array<LobeShape, 3> shapes{};
};

DualScattering::Lobes DualScattering::lobes(double thetaD) const {
    Lobes lobes{};
    if (marschner_ != nullptr) {
        const AzimuthalProfile::Grid grid = marschner_->azimuthal(thetaD).grid();
        for (const Lobe lobe : kLobes) {
            const auto scale = static_cast<float>(marschner_->scale(lobe));
            const LongitudinalLobe& l = marschner_->longitudinalLobe(lobe);
            lobes.shapes[index(lobe)] = {l.tilt(), l.width()};
            for (std::size_t c = 0; c < 3; ++c) {
                const auto& from = lobe == Lobe::R ? grid.r : lobe == Lobe::TT ? grid.tt[c] : grid.trt[c];
                for (std::size_t i = 0; i <= kLast; ++i) lobes.rows[index(lobe)][c][i] = scale * from[i];
            }
        }
        return lobes;
    }
    for (const Lobe lobe : kLobes) {
        const SadeghiLobe& l = sadeghi_.lobe(lobe);
        lobes.shapes[index(lobe)] = {l.shift, l.width / std::sqrt(2 * kPi)};
        for (std::size_t i = 0; i <= kLast; ++i) {
            const double n = longitudinal_->energy(lobe) *
                             sadeghiAzimuthal(sadeghi_, lobe, static_cast<double>(i) * kStep, 0.5);
            const Vec3d light = l.light();
            for (std::size_t c = 0; c < 3; ++c) {
                lobes.rows[index(lobe)][c][i] = static_cast<float>(n * light[static_cast<int>(c)]);
            }
        }
    }
    return lobes;
}

DualScattering::Row DualScattering::at(double thetaD) const {
    const Lobes parts = lobes(thetaD);
    Row row{averageOf(parts.rows, parts.shapes), profileOf(parts.rows)};
    row.average.first = -momentOf(row.profile, 1);
    row.average.second = momentOf(row.profile, 2);
    for (int c = 0; c < 3; ++c) {
        const double albedo = row.average.forward[c] + row.average.backward[c];
        if (albedo <= kMaxAlbedo) continue;
        const double factor = kMaxAlbedo / albedo;
        for (Vec3d* share :
             {&row.average.forward, &row.average.backward, &row.average.first, &row.average.second}) {
            (*share)[c] *= factor;
        }
        for (float& n : row.profile[static_cast<std::size_t>(c)]) n *= static_cast<float>(factor);
    }
    return row;
}

std::array<DualScattering::Moments, 3> DualScattering::moments(double thetaD) const {
    const Lobes parts = lobes(thetaD);
    std::array<Moments, 3> result;
    for (const Lobe lobe : kLobes) {
        for (int m = 0; m < 4; ++m)
            result[index(lobe)][static_cast<std::size_t>(m)] = momentOf(parts.rows[index(lobe)], m);
    }
    return result;
}

double DualScattering::longitudinal(Lobe lobe, double thetaIn, double thetaOut) const {
    if (marschner_ != nullptr) return marschner_->longitudinalLobe(lobe)(thetaIn, thetaOut);
    return (*longitudinal_)(lobe, thetaIn, thetaOut) / longitudinal_->energy(lobe);
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
    const LayerLight light = beamInLayer(a, before, all, ground);
    const Vec3d onward = (light.onward - Vec3d::Constant(std::exp(-before))).cwiseMax(0.0);
    const double cosine = std::max(std::cos(0.5 * (thetaOut - thetaIn)), 1e-6);
    const double factor = std::cos(thetaIn) / (cosine * cosine);
    const double x = std::abs(wrapAngle(phi)) / kStep;
    const auto i = std::min(static_cast<std::size_t>(x), kLast - 1);
    const double t = x - static_cast<double>(i);
    Vec3d n;
    for (std::size_t c = 0; c < 3; ++c) {
        n[static_cast<int>(c)] =
            (1 - t) * static_cast<double>(row.profile[c][i]) + t * static_cast<double>(row.profile[c][i + 1]);
    }
    // The radiance (φ + 2 J cos ψ)/2π around the fibre, scattered.
    const Vec3d diffuse = ((a.forward + a.backward).cwiseProduct(light.fluence) -
                           2 * std::cos(phi) * a.first.cwiseProduct(light.flux))
                              .cwiseMax(0.0) /
                          (2 * kPi);
    // Each scattering adds its variance and its tilt (Zinke et al. 2008). Diffuse light has turned once more
    // and, near the surface, passed two fibres more on its way.
    const double passed = scatteringsOf(before * a.forward.mean());
    const double onwardM = spreadLongitudinal(a.tilt() + passed * a.forwardTilt,
                                              a.variance() + passed * a.forwardVariance, thetaIn, thetaOut);
    const double diffuseM = spreadLongitudinal(
        a.tilt() + (passed + 1) * a.forwardTilt + a.backwardTilt,
        a.variance() + (passed + 1) * a.forwardVariance + a.backwardVariance, thetaIn, thetaOut);
    return factor * (onwardM * onward.cwiseProduct(n) + diffuseM * diffuse);
}

}  // namespace hairloom::shading
