// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/dual_scattering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/shading/melanin.h"
#include "core/shading/tables.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;

Marschner hair(double eumelanin) {
    MarschnerParameters parameters;
    parameters.azimuthal.absorption = absorption({eumelanin, 0});
    parameters.azimuthal.width = azimuthalWidth(0.3);
    parameters.azimuthal.causticWidth = 0;
    return Marschner(parameters);
}

double sample(const std::array<float, AzimuthalProfile::kGridSize>& row, double phi) {
    const double x = std::abs(wrapAngle(phi)) / kPi * static_cast<double>(row.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), row.size() - 2);
    const double t = x - static_cast<double>(i);
    return (1 - t) * static_cast<double>(row[i]) + t * static_cast<double>(row[i + 1]);
}

TEST(DualScattering, HalvesTogetherAreTheAlbedo) {
    const Marschner model = hair(0.3);
    for (const double theta : {0.0, 0.6, 1.3}) {
        const AverageScattering a = DualScattering(model).at(theta).average;
        const AzimuthalProfile profile = model.azimuthal(theta);
        Vec3d albedo = Vec3d::Zero();
        for (const Lobe lobe : kLobes) albedo += model.scale(lobe) * profile.energy(lobe);
        EXPECT_TRUE((a.forward + a.backward).isApprox(albedo, 2e-3));
        EXPECT_GT(a.forward.x(), a.backward.x());
        EXPECT_GT(a.forward.x(), a.forward.z());
        EXPECT_GT(a.backwardVariance, a.forwardVariance);  // R and TRT are wider than TT
    }
}

TEST(DualScattering, SpreadKeepsTheAlbedoToo) {
    const Marschner model = hair(0.3);
    const DualScattering::Row row = DualScattering(model).at(0.3);
    for (int c = 0; c < 3; ++c) {
        double around = 0;
        for (int i = 0; i < 720; ++i) {
            around += sample(row.spread[static_cast<std::size_t>(c)], (i + 0.5) * kPi / 360) * kPi / 360;
        }
        EXPECT_NEAR(around, row.average.forward[c] + row.average.backward[c], 2e-3);
    }
}

TEST(DualScattering, TwoFluxSolvesItsEquations) {
    const Vec3d forward(0.6, 0.4, 0.78), backward(0.2, 0.05, 0.21);
    constexpr double kAll = 4, kSmall = 1e-4;
    for (const double before : {0.5, 2.0, 3.5}) {
        const TwoFlux at = twoFlux(forward, backward, before, kAll);
        const TwoFlux later = twoFlux(forward, backward, before + kSmall, kAll);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR((later.down[c] - at.down[c]) / kSmall,
                        -(1 - forward[c]) * at.down[c] + backward[c] * at.up[c], 1e-3);
            EXPECT_NEAR((later.up[c] - at.up[c]) / kSmall,
                        (1 - forward[c]) * at.up[c] - backward[c] * at.down[c], 1e-3);
        }
    }
    EXPECT_TRUE(twoFlux(forward, backward, 0, kAll).down.isApprox(Vec3d::Ones(), 1e-12));
    EXPECT_NEAR(twoFlux(forward, backward, kAll, kAll).up.norm(), 0, 1e-12);
    // Fibres that absorb all leave what has met none.
    EXPECT_NEAR(twoFlux(Vec3d::Zero(), Vec3d::Zero(), 2, 3).down.x(), std::exp(-2.0), 1e-3);
}

TEST(DualScattering, GroundSendsBackItsShare) {
    const Vec3d forward(0.6, 0.4, 0.78), backward(0.2, 0.05, 0.21), ground(0.5, 0.35, 0.9);
    constexpr double kAll = 3, kSmall = 1e-4;
    const auto down = [&](double before) {
        const TwoFlux f = twoFlux(forward, backward, before, kAll, ground);
        return Vec3d(f.down + f.groundDown);
    };
    const auto up = [&](double before) {
        const TwoFlux f = twoFlux(forward, backward, before, kAll, ground);
        return Vec3d(f.up + f.groundUp);
    };
    EXPECT_TRUE(up(kAll).isApprox(ground.cwiseProduct(down(kAll)), 1e-9));
    EXPECT_TRUE(down(0).isApprox(Vec3d::Ones(), 1e-9));
    for (const double before : {0.3, 1.5, 2.5}) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR((down(before + kSmall) - down(before))[c] / kSmall,
                        -(1 - forward[c]) * down(before)[c] + backward[c] * up(before)[c], 1e-3);
            EXPECT_NEAR((up(before + kSmall) - up(before))[c] / kSmall,
                        (1 - forward[c]) * up(before)[c] - backward[c] * down(before)[c], 1e-3);
        }
    }
    const TwoFlux black = twoFlux(forward, backward, 1, kAll);
    EXPECT_EQ(black.groundUp.norm() + black.groundDown.norm(), 0);
}

/// Light that a slab of parallel fibres, lit across, sends back at an angle to its normal: all of it over
/// what has been scattered once.
struct SlabRatio {
    double traced, dual;
};
SlabRatio slab(double eumelanin, int channel, double depth, double cameraAngle, double ground = 0) {
    const Marschner model = hair(eumelanin);
    const AzimuthalProfile::Grid grid = model.azimuthal(0).grid();
    const auto c = static_cast<std::size_t>(channel);
    std::array<float, AzimuthalProfile::kGridSize> n{};
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = grid.r[i] + grid.tt[c][i] + grid.trt[c][i];
    constexpr int kSteps = 360;
    std::array<double, kSteps + 1> chance{};
    for (std::size_t i = 0; i < kSteps; ++i) {
        chance[i + 1] =
            chance[i] + sample(n, (static_cast<double>(i) + 0.5) * 2 * kPi / kSteps) * 2 * kPi / kSteps;
    }
    const double albedo = chance.back();
    const double cosine = std::cos(cameraAngle);

    Random random(1);
    double once = 0, all = 0;
    for (int ray = 0; ray < 20000; ++ray) {
        double at = 0, heading = 0, weight = 1;  // heading 0: into the slab
        bool fresh = true;
        while (weight > 1e-3) {
            at -= std::cos(heading) * std::log(1 - random.uniformDouble());
            if (at > depth && ground > 0) {
                // A matte ground, in the plane across the fibres.
                at = depth;
                weight *= ground;
                heading = kPi + std::asin(2 * random.uniformDouble() - 1);
                fresh = false;
                continue;
            }
            if (at < 0 || at > depth) break;
            const double seen = weight * sample(n, cameraAngle - heading) * std::exp(-at / cosine) / cosine;
            if (fresh) once += seen;
            fresh = false;
            all += seen;
            weight *= albedo;
            const double drawn = random.uniformDouble() * albedo;
            const auto above = std::upper_bound(chance.begin(), chance.end(), drawn);
            const double i = static_cast<double>(above - chance.begin()) - 1;
            const double part = (drawn - *(above - 1)) / (*above - *(above - 1));
            heading += kPi + (i + part) * 2 * kPi / kSteps;
        }
    }

    const DualScattering::Row row = DualScattering(model).at(0);
    double single = 0, multiple = 0;
    constexpr int kLayers = 400;
    const double step = std::min(depth, 20.0) / kLayers;
    for (int i = 0; i < kLayers; ++i) {
        const double before = (i + 0.5) * step;
        const double seen = std::exp(-before / cosine) / cosine * step;
        const TwoFlux flux =
            twoFlux(row.average.forward, row.average.backward, before, depth, Vec3d::Constant(ground));
        const double down = flux.down[channel] + kPi / 2 * flux.groundDown[channel] - std::exp(-before);
        single += seen * std::exp(-before) * sample(n, cameraAngle);
        multiple +=
            seen * (down * sample(row.spread[c], cameraAngle) +
                    (flux.up + kPi / 2 * flux.groundUp)[channel] * sample(row.spread[c], cameraAngle + kPi));
    }
    return {all / once, 1 + multiple / single};
}

TEST(DualScattering, BrightensASlabAsTracedLightDoes) {
    for (const double eumelanin : {0.3, 1.3, 8.0}) {
        for (int channel = 0; channel < 3; ++channel) {
            for (const double depth : {2.0, 5.0, 100.0}) {
                for (const double degrees : {0.0, 43.0, 70.0}) {
                    const SlabRatio ratio = slab(eumelanin, channel, depth, degrees * kDegree);
                    EXPECT_NEAR(ratio.dual, ratio.traced, 0.13 * ratio.traced)
                        << "eumelanin " << eumelanin << " channel " << channel << " depth " << depth
                        << " camera " << degrees;
                }
            }
        }
    }
}

TEST(DualScattering, SkinUnderASlabBrightensItAsTracedLightDoes) {
    for (const double eumelanin : {0.3, 1.3, 8.0}) {
        for (const double depth : {1.0, 2.0, 5.0}) {
            for (const double degrees : {0.0, 43.0}) {
                const SlabRatio ratio = slab(eumelanin, 0, depth, degrees * kDegree, 0.5);
                EXPECT_NEAR(ratio.dual, ratio.traced, 0.2 * ratio.traced)
                    << "eumelanin " << eumelanin << " depth " << depth << " camera " << degrees;
            }
        }
    }
}

TEST(DualScattering, AddsLittleToBlackHairAndMuchToBlond) {
    EXPECT_GT(slab(0.3, 0, 5, 0.7).dual, 4);
    EXPECT_LT(slab(8, 0, 5, 0.7).dual, 1.1);
}

TEST(DualScattering, SadeghiFollowsMarschner) {
    const Marschner model = hair(0.3);
    const AverageScattering m = DualScattering(model).at(0).average;
    const AverageScattering s = DualScattering(sadeghiLike(model)).at(0).average;
    EXPECT_TRUE(s.forward.isApprox(m.forward, 0.1));
    EXPECT_TRUE((s.forward + s.backward).isApprox(m.forward + m.backward, 0.03));
    SadeghiParameters bright = sadeghiLike(model);
    bright.tt.intensity *= 10;
    const AverageScattering b = DualScattering(bright).at(0).average;
    EXPECT_LE((b.forward + b.backward).maxCoeff(), 0.9801);
}

TEST(DualScattering, TablesHoldTheModel) {
    const Marschner model = hair(1.3);
    const DualScattering dual(model);
    const DualTables tables = bakeDual(dual, 64, 32);
    const DualScattering::Row row = dual.at(0.5 * kPi / 2 * 20 / 15.5);
    const auto forward = tables.averages.sample(20 / 31.0, 0);
    const auto backward = tables.averages.sample(20 / 31.0, 0.5);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(forward[c], row.average.forward[static_cast<int>(c)], 1e-6);
        EXPECT_NEAR(backward[c], row.average.backward[static_cast<int>(c)], 1e-6);
        EXPECT_NEAR(tables.spread.sample(0.8, 20 / 31.0)[c], sample(row.spread[c], std::acos(0.6)),
                    0.01 * static_cast<double>(row.spread[c][90]));
    }
    const Table factors = bakeSpreadFactors();
    const double width = kLeastSpread + 0.31 * (kLargestSpread - kLeastSpread);
    EXPECT_NEAR(factors.sample(0.4, 0.31)[0], LongitudinalLobe(0, width).factorOut(std::asin(0.4)), 2e-3);
}

}  // namespace
}  // namespace hairloom::shading
