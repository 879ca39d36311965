// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/marschner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shading/cylinder_trace.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;

double cosRatio(double thetaIn, double thetaOut) {
    const double ratio = std::cos(thetaOut) / std::cos(0.5 * (thetaOut - thetaIn));
    return ratio * ratio;
}

double energyOf(const LongitudinalLobe& lobe, double thetaIn) {
    constexpr int kSteps = 2000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double out = (i + 0.5) * kPi / kSteps - kPi / 2;
        sum += lobe(thetaIn, out) * cosRatio(thetaIn, out) * kPi / kSteps;
    }
    return sum;
}

TEST(Longitudinal, EveryLobeConservesEnergy) {
    for (const double width : {1.0, 4.0, 8.3, 17.0, 40.0}) {
        for (const double tilt : {0.0, -2.0, 3.0, -7.0}) {
            const LongitudinalLobe lobe(tilt * kDegree, width * kDegree);
            for (const double degrees : {0.0, 30.0, -30.0, 60.0, -60.0, 75.0}) {
                if (std::abs(2 * tilt - degrees) > 80)
                    continue;  // the lobe's middle would be beyond the axis
                EXPECT_NEAR(energyOf(lobe, degrees * kDegree), 1, 4e-3)
                    << width << " " << tilt << " " << degrees;
            }
        }
    }
}

// Eq. 34 and 35 normalise over θ_h, which moves half as far as θ_o.
TEST(Longitudinal, ThePrintedGaussianGivesTwiceTheLight) {
    const LongitudinalLobe lobe(0, 3.75 * kDegree);
    double printed = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double out = (i + 0.5) * kPi / kSteps - kPi / 2;
        printed += lobe.gauss(0.5 * out) * cosRatio(0, out) * kPi / kSteps;
    }
    EXPECT_NEAR(printed, 1.97, 0.02);
    EXPECT_NEAR(energyOf(lobe, 0), 1, 1e-3);
}

TEST(Longitudinal, HighlightsLieOppositeTheLightMovedByTheTilt) {
    for (const double tilt : {-3.0, 0.0, 2.0}) {
        const LongitudinalLobe lobe(tilt * kDegree, 2 * kDegree);
        double best = 0, at = 0;
        for (double out = -89; out < 89; out += 0.1) {
            const double value = lobe(20 * kDegree, out * kDegree);
            if (value > best) {
                best = value;
                at = out;
            }
        }
        EXPECT_NEAR(at, -20 + 2 * tilt, 0.3);
    }
}

double furnace(const Marschner& model, double thetaIn) {
    constexpr int kSteps = 90;
    constexpr std::size_t kLast = AzimuthalProfile::kGridSize - 1;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double out = (i + 0.5) * kPi / kSteps - kPi / 2;
        const AzimuthalProfile::Grid grid = model.azimuthal(0.5 * (out - thetaIn)).grid();
        double around = 0;
        for (std::size_t k = 0; k < kLast; ++k) {
            const auto mean = [&](const auto& row) { return 0.5 * static_cast<double>(row[k] + row[k + 1]); };
            around += (model.longitudinal(Lobe::R, thetaIn, out) * mean(grid.r) +
                       model.longitudinal(Lobe::TT, thetaIn, out) * mean(grid.tt[0]) +
                       model.longitudinal(Lobe::TRT, thetaIn, out) * mean(grid.trt[0])) *
                      2 * kPi / static_cast<double>(kLast);
        }
        sum += around * cosRatio(thetaIn, out) * kPi / kSteps;
    }
    return sum;
}

TEST(Marschner, WhiteFurnace) {
    for (const double width : {3.75, 7.5, 10.0}) {
        MarschnerParameters parameters;
        setScales(parameters, 2 * kDegree, width * kDegree);
        parameters.azimuthal.width = 0.2;
        const Marschner model(parameters);
        for (const double degrees : {0.0, 20.0, -40.0, 55.0}) {
            const double theta = degrees * kDegree;
            const double beyond = model.azimuthal(theta).energyBeyond().x();
            const double energy = furnace(model, theta);
            EXPECT_LE(energy, 1) << width << " " << degrees;
            EXPECT_NEAR(energy + beyond, 1, 0.02) << width << " " << degrees;
        }
    }
}

TEST(Marschner, WhiteFurnaceOfTheSmoothFibre) {
    const Marschner model{MarschnerParameters{}};
    for (const double degrees : {0.0, 45.0}) {
        const double beyond = model.azimuthal(degrees * kDegree).energyBeyond().x();
        EXPECT_NEAR(furnace(model, degrees * kDegree) + beyond, 1, 0.02);
    }
}

TEST(Marschner, NeverGainsEnergy) {
    Random random(4);
    for (int i = 0; i < 40; ++i) {
        MarschnerParameters parameters;
        parameters.azimuthal.ior = random.uniform(1.2f, 2.2f);
        parameters.azimuthal.width = random.uniform(0.05f, 0.8f);
        parameters.azimuthal.causticWidth = random.uniform(0.0f, 0.4f);
        parameters.azimuthal.axisRatio = random.uniform(0.8f, 1.25f);
        for (std::size_t p = 0; p < 3; ++p) {
            parameters.tilt[p] = random.uniform(-0.15f, 0.15f);
            parameters.width[p] = random.uniform(0.03f, 0.6f);
        }
        const Marschner model(parameters);
        EXPECT_LE(furnace(model, random.uniform(-1.5f, 1.5f)), 1.003) << i;
    }
}

TEST(Marschner, IsReciprocalWithoutTilt) {
    MarschnerParameters parameters;
    parameters.tilt = {0, 0, 0};
    parameters.azimuthal.absorption = Vec3d(0.1, 0.3, 1);
    const Marschner model(parameters);
    Random random(6);
    for (int i = 0; i < 300; ++i) {
        const double a = random.uniform(-1.4f, 1.4f), b = random.uniform(-1.4f, 1.4f),
                     phi = random.uniform(-3.1f, 3.1f);
        const Vec3d there = model(a, b, phi);
        EXPECT_TRUE(there.isApprox(model(b, a, -phi), 1e-9));
        EXPECT_GE(there.minCoeff(), 0);
    }
}

TEST(Marschner, LightPassesThroughRatherThanBack) {
    MarschnerParameters parameters;
    const Marschner blond(parameters);
    EXPECT_GT(blond(0.1, -0.1, kPi).x(), 5 * blond(0.1, -0.1, 0).x());
    parameters.azimuthal.absorption = Vec3d::Constant(4);
    const Marschner black(parameters);
    EXPECT_LT(black(0.1, -0.1, kPi).x(), black(0.1, -0.1, 0.5).x());
}

TEST(FibreAngles, AreThoseOfTheirVectors) {
    const Vec3d tangent = Vec3d(1, 2, -1).normalized();
    const Vec3d x = tangent.unitOrthogonal();
    const Vec3d y = tangent.cross(x);
    const auto direction = [&](double theta, double phi) {
        return Vec3d(std::sin(theta) * tangent + std::cos(theta) * (std::cos(phi) * x + std::sin(phi) * y));
    };
    const FibreAngles angles = fibreAngles(tangent, direction(0.4, 0.3), direction(-0.7, 2.5));
    EXPECT_NEAR(angles.thetaIn, 0.4, 1e-12);
    EXPECT_NEAR(angles.thetaOut, -0.7, 1e-12);
    EXPECT_NEAR(angles.phi, 2.2, 1e-12);
    EXPECT_EQ(fibreAngles(tangent, tangent, direction(0, 0)).phi, 0);
}

// All that leaves a straight fibre leaves on the cone of the mirrored light, with the energies of the model.
TEST(CylinderTrace, SmoothFibresKeepTheInclination) {
    constexpr int kRays = 20000;
    for (const double degrees : {0.0, 20.0, 45.0, 70.0}) {
        for (const double absorption : {0.0, 0.2, 1.0}) {
            test::CylinderTrace cylinder;
            cylinder.absorption = absorption;
            Random random(9);
            std::array<double, 3> energy{};
            for (int i = 0; i < kRays; ++i) {
                const double h = 2 * (i + random.uniformDouble()) / kRays - 1;
                cylinder.trace(degrees * kDegree, h, 2, random, [&](const test::Exit& exit) {
                    ASSERT_NEAR(exit.direction.z(), -std::sin(degrees * kDegree), 1e-9);
                    energy[static_cast<std::size_t>(exit.order)] += exit.weight / kRays;
                });
            }
            AzimuthalParameters parameters;
            parameters.absorption = Vec3d::Constant(absorption);
            const AzimuthalProfile profile(parameters, degrees * kDegree);
            for (const Lobe lobe : kLobes) {
                EXPECT_NEAR(energy[index(lobe)], profile.energy(lobe).x(), 5e-4)
                    << degrees << " " << absorption;
            }
        }
    }
}

// Scales tilted by random amounts, in the plane of incidence: the mean of θ_h is the lobe's tilt, the spread
// of R its width. TT and TRT follow R as setScales() says.
TEST(CylinderTrace, TiltedScalesMoveAndWidenTheLobes) {
    const double scaleTilt = 2 * kDegree, spread = 1.5 * kDegree;
    MarschnerParameters parameters;
    setScales(parameters, scaleTilt, spread);
    for (const double degrees : {0.0, 20.0}) {
        test::CylinderTrace cylinder;
        cylinder.normalTilt = [&](Random& random) {
            return -scaleTilt + spread * test::normalNumber(random);
        };
        Random random(23);
        std::array<double, 3> weight{}, mean{}, square{};
        for (int i = 0; i < 40000; ++i) {
            cylinder.trace(degrees * kDegree, 0, 2, random, [&](const test::Exit& exit) {
                const auto p = static_cast<std::size_t>(exit.order);
                const double half = 0.5 * (degrees * kDegree + std::asin(exit.direction.z()));
                weight[p] += exit.weight;
                mean[p] += exit.weight * half;
                square[p] += exit.weight * half * half;
            });
        }
        for (const Lobe lobe : kLobes) {
            const std::size_t p = index(lobe);
            const double tilt = mean[p] / weight[p];
            EXPECT_NEAR(tilt, parameters.tilt[p], 0.25 * kDegree) << degrees << " " << p;
            if (lobe == Lobe::R) {
                EXPECT_NEAR(std::sqrt(square[p] / weight[p] - tilt * tilt), parameters.width[p],
                            0.05 * kDegree);
            }
        }
    }
}

}  // namespace
}  // namespace hairloom::shading
