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

TEST(DualScattering, MomentsAreThoseOfItsProfile) {
    const Marschner model = hair(0.3);
    const DualScattering::Row row = DualScattering(model).at(0.3);
    const AverageScattering& a = row.average;
    for (int c = 0; c < 3; ++c) {
        double all = 0, first = 0, second = 0;
        for (int i = 0; i < 720; ++i) {
            const double turned = (i + 0.5) * kPi / 360;
            const double n = sample(row.profile[static_cast<std::size_t>(c)], turned + kPi) * kPi / 360;
            all += n;
            first += n * std::cos(turned);
            second += n * std::cos(2 * turned);
        }
        EXPECT_NEAR(all, a.forward[c] + a.backward[c], 2e-3);
        EXPECT_NEAR(first, a.first[c], 2e-3);
        EXPECT_NEAR(second, a.second[c], 2e-3);
    }
    EXPECT_GT(a.first.x(), a.second.x());  // TT goes on, not quite straight
    EXPECT_GT(a.second.x(), a.second.z());
}

AverageScattering fibre() {
    AverageScattering a;
    a.forward = Vec3d(0.6, 0.4, 0.78);
    a.backward = Vec3d(0.2, 0.05, 0.21);
    a.first = Vec3d(0.35, 0.3, 0.5);
    a.second = Vec3d(0.2, -0.1, 0.3);
    return a;
}

/// The equations of P1 by finite differences, and what comes in at both sides.
void expectSolved(const Vec3d& ground) {
    constexpr double kAll = 4, kSmall = 1e-4;
    const AverageScattering a = fibre();
    const auto at = [&](double before) { return beamInLayer(a, before, kAll, ground); };
    for (int c = 0; c < 3; ++c) {
        const double peak = std::max(a.second[c], 0.0), albedo = a.forward[c] + a.backward[c];
        const double lost = 1 - albedo, turned = 2 * (1 - a.first[c]);  // by fibre, not scaled
        for (const double before : {0.5, 2.0, 3.5}) {
            const LayerLight low = at(before - kSmall), here = at(before), high = at(before + kSmall);
            const double flux = (high.flux[c] - low.flux[c]) / (2 * kSmall);
            const double fluence = (high.fluence[c] - low.fluence[c]) / (2 * kSmall);
            EXPECT_NEAR(flux, -lost * here.fluence[c] + (albedo - peak) * here.onward[c], 1e-4);
            EXPECT_NEAR(fluence, -turned * here.flux[c] + 2 * (a.first[c] - peak) * here.onward[c], 1e-4);
            EXPECT_NEAR(here.onward[c], std::exp(-(1 - peak) * before), 1e-12);
        }
        const LayerLight top = at(0), bottom = at(kAll);
        EXPECT_NEAR(top.fluence[c] / kPi + top.flux[c] / 2, 0, 1e-9);
        const double down = bottom.onward[c] + bottom.fluence[c] / kPi + bottom.flux[c] / 2;
        EXPECT_NEAR(bottom.fluence[c] / kPi - bottom.flux[c] / 2, ground[c] * down, 1e-9);
    }
}

TEST(DualScattering, LightInLayersSolvesItsEquations) {
    expectSolved(Vec3d::Zero());
    expectSolved(Vec3d(0.5, 0.35, 0.9));
    // Fibres that absorb all leave what has met none.
    const LayerLight black = beamInLayer({}, 2, 3);
    EXPECT_NEAR(black.onward.x(), std::exp(-2.0), 1e-12);
    EXPECT_NEAR(black.fluence.x(), 0, 2e-3);
}

// Where the beam would fade exactly as diffuse light does, the solution has a pole, beside which it is taken.
TEST(DualScattering, LightInLayersIsContinuous) {
    for (double albedo = 0.3; albedo < 0.7; albedo += 0.001) {
        const auto light = [](double share) {
            AverageScattering a;
            a.forward.setConstant(share);
            return beamInLayer(a, 1, 3).fluence.x();
        };
        EXPECT_NEAR(light(albedo), light(albedo + 0.001), 0.02) << albedo;
    }
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
        const LayerLight light = beamInLayer(row.average, before, depth, Vec3d::Constant(ground));
        const double scattered =
            (row.average.forward + row.average.backward)[channel] * light.fluence[channel];
        const double turned = 2 * cosine * row.average.first[channel] * light.flux[channel];
        single += seen * std::exp(-before) * sample(n, cameraAngle);
        multiple += seen * ((light.onward[channel] - std::exp(-before)) * sample(n, cameraAngle) +
                            (scattered - turned) / (2 * kPi));
    }
    return {all / once, 1 + multiple / single};
}

TEST(DualScattering, BrightensASlabAsTracedLightDoes) {
    for (const double eumelanin : {0.3, 1.3, 8.0}) {
        for (int channel = 0; channel < 3; ++channel) {
            for (const double depth : {2.0, 5.0, 100.0}) {
                for (const double degrees : {0.0, 43.0, 70.0}) {
                    const SlabRatio ratio = slab(eumelanin, channel, depth, degrees * kDegree);
                    EXPECT_NEAR(ratio.dual, ratio.traced, 0.12 * ratio.traced)
                        << "eumelanin " << eumelanin << " channel " << channel << " depth " << depth
                        << " camera " << degrees;
                }
            }
        }
    }
}

TEST(DualScattering, WhiteHairIsWhite) {
    for (const double depth : {2.0, 5.0, 100.0}) {
        for (const double degrees : {0.0, 43.0, 70.0}) {
            const SlabRatio ratio = slab(0, 0, depth, degrees * kDegree);
            EXPECT_NEAR(ratio.dual, ratio.traced, 0.2 * ratio.traced) << depth << " camera " << degrees;
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
    EXPECT_LE((b.forward + b.backward).maxCoeff(), 0.9951);
}

TEST(DualScattering, TablesHoldTheModel) {
    const Marschner model = hair(1.3);
    const DualScattering dual(model);
    const DualTables tables = bakeDual(dual, 64, 32);
    const DualScattering::Row row = dual.at(0.5 * kPi / 2 * 20 / 15.5);
    const auto forward = tables.averages.sample(20 / 31.0, 0);
    const auto backward = tables.averages.sample(20 / 31.0, 0.25);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(forward[c], row.average.forward[static_cast<int>(c)], 1e-6);
        EXPECT_NEAR(backward[c], row.average.backward[static_cast<int>(c)], 1e-6);
        EXPECT_NEAR(tables.profile.sample(0.8, 20 / 31.0)[c], sample(row.profile[c], std::acos(0.6)),
                    0.01 * static_cast<double>(row.profile[c][90]));
    }
    const Table factors = bakeSpreadFactors();
    const double width = kMinSpread + 0.31 * (kLargestSpread - kMinSpread);
    EXPECT_NEAR(factors.sample(0.4, 0.31)[0], LongitudinalLobe(0, width).factorOut(std::asin(0.4)), 2e-3);
}

}  // namespace
}  // namespace hairloom::shading
