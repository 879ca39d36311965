// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kThetas = 180;   // of light: the width of the narrowest lobe
constexpr int kProfiles = 24;  // over |θ_d|

/// The moments of N at some |θ_d|, linear between them.
class AzimuthalMoments {
  public:
    explicit AzimuthalMoments(const DualScattering& model) {
        parallelFor(rows_.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                rows_[i] = model.moments(std::min(static_cast<double>(i) * kStep, 0.499 * kPi));
        });
    }
    Vec3d operator()(Lobe lobe, std::size_t order, double thetaD) const {
        const double x = std::min(std::abs(thetaD) / kStep, kProfiles - 1.001);
        const auto i = static_cast<std::size_t>(x);
        const double t = x - static_cast<double>(i);
        return (1 - t) * rows_[i][index(lobe)][order] + t * rows_[i + 1][index(lobe)][order];
    }

  private:
    static constexpr double kStep = kPi / 2 / (kProfiles - 1);
    std::array<std::array<DualScattering::Moments, 3>, kProfiles> rows_;
};

SkyMoments momentsAt(const DualScattering& model, const AzimuthalMoments& azimuthal, double thetaOut) {
    SkyMoments sum;
    for (int i = 0; i < kThetas; ++i) {
        const double thetaIn = ((i + 0.5) / kThetas - 0.5) * kPi;
        const double sine = std::sin(thetaIn), cosine = std::cos(thetaIn);
        const double thetaD = 0.5 * (thetaOut - thetaIn), cosD = std::cos(thetaD);
        for (const Lobe lobe : kLobes) {
            // dω = cos θ_i dθ_i dφ.
            const double weight = model.longitudinal(lobe, thetaIn, thetaOut) * cosine * cosine /
                                  (cosD * cosD) * (kPi / kThetas);
            if (weight < 1e-9) continue;
            const Vec3d zeroth = weight * azimuthal(lobe, 0, thetaD);
            const Vec3d first = weight * azimuthal(lobe, 1, thetaD);
            sum.even += zeroth;
            sum.along += sine * zeroth;
            sum.across += cosine * first;
            sum.alongAlong += 0.5 * (3 * sine * sine - 1) * zeroth;
            sum.alongAcross += sine * cosine * first;
            sum.acrossAcross += cosine * cosine * weight * azimuthal(lobe, 2, thetaD);
            sum.third += cosine * cosine * cosine * weight * azimuthal(lobe, 3, thetaD);
        }
    }
    return sum;
}

}  // namespace

Table bakeSky(const DualScattering& model, std::uint32_t size) {
    const AzimuthalMoments azimuthal(model);
    Table table{size, 7, std::vector<float>(std::size_t{4} * size * 7)};
    parallelFor(size, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t x = begin; x < end; ++x) {
            const double sine = 2 * static_cast<double>(x) / (size - 1) - 1;
            const SkyMoments m = momentsAt(model, azimuthal, std::clamp(std::asin(sine), -1.55, 1.55));
            std::uint32_t row = 0;
            for (const Vec3d* moment :
                 {&m.even, &m.along, &m.across, &m.alongAlong, &m.alongAcross, &m.acrossAcross, &m.third}) {
                float* texel = table.texel(static_cast<std::uint32_t>(x), row++);
                for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>((*moment)[c]);
                texel[3] = 1;
            }
        }
    });
    return table;
}

}  // namespace hairloom::shading
