// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/kajiya_kay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hairloom::shading {
namespace {

constexpr double kPiDouble = std::numbers::pi;

Vec3d direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

// Light sent out over the whole sphere, per light that meets the fibre, by the midpoint rule. The model does
// not depend on azimuth, so one integral over the inclination is enough.
double albedo(const KajiyaKay& model, double lightTheta) {
    const Vec3d tangent = Vec3d::UnitY();
    const Vec3d toLight = direction(lightTheta, 0);
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double theta = (i + 0.5) * kPiDouble / kSteps;
        const double out = evaluate(model, tangent, toLight, direction(theta, 1.0));
        sum += out * std::sin(theta) * std::sin(theta);  // projected length, solid angle
    }
    return 2 * kPiDouble * sum * kPiDouble / kSteps / std::sin(lightTheta);
}

TEST(KajiyaKay, ReflectanceIsEquation31AndNotTable2) {
    // Printed: 19.7392 (m = 1), 15.5031 (m = 2).
    EXPECT_NEAR(kajiyaReflectance(0), kPiDouble, 1e-12);
    EXPECT_NEAR(kajiyaReflectance(1), 2.6667, 5e-5);
    EXPECT_NEAR(kajiyaReflectance(2), 2.3562, 5e-5);
    EXPECT_NEAR(kajiyaReflectance(3), 2.1333, 5e-5);
    EXPECT_NEAR(kajiyaReflectance(8), 1.5463, 5e-5);
    EXPECT_NEAR(kajiyaReflectance(21), 1.0340, 5e-5);
}

TEST(KajiyaKay, ReflectanceAgreesWithQuadrature) {
    for (const double m : {0.0, 0.5, 1.0, 7.0, 17.0, 64.0, 333.3, 1000.0}) {
        constexpr int kSteps = 100000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) sum += std::pow(std::sin((i + 0.5) * kPiDouble / kSteps), m + 2);
        EXPECT_NEAR(kajiyaReflectance(m), 2 * sum * kPiDouble / kSteps, 1e-7) << m;
    }
}

TEST(KajiyaKay, NeverGainsEnergy) {
    for (int m = 0; m <= 1000; m += m < 32 ? 1 : 44) {
        for (const double theta : {0.05, 0.4, 0.9, 1.3, kPiDouble / 2, 2.2}) {
            EXPECT_LE(albedo({0, 1, static_cast<double>(m)}, theta), 1 + 1e-6) << m << " " << theta;
            EXPECT_LE(albedo({0.6, 0.4, static_cast<double>(m)}, theta), 1 + 1e-6) << m << " " << theta;
        }
    }
}

// Eq. 32 divides the diffuse light by what the specular light reflects.
TEST(KajiyaKay, DiffuseLightIsDividedByWhatItReflectsItself) {
    const double m = 60;
    const double diffuse = albedo({1, 0, m}, kPiDouble / 2);
    EXPECT_LE(diffuse, 1 + 1e-6);
    EXPECT_NEAR(diffuse * kajiyaReflectance(0) / kajiyaReflectance(m), 4.95, 5e-3) << "as printed";
}

TEST(KajiyaKay, LosesNoEnergyAcrossTheFibre) {
    for (const double m : {0.0, 1.0, 20.0, 400.0}) {
        EXPECT_NEAR(albedo({1, 0, m}, kPiDouble / 2), 1, 1e-6);
        EXPECT_NEAR(albedo({0, 1, m}, kPiDouble / 2), 1, 1e-6);
    }
}

TEST(KajiyaKay, TheBoundIsOneByTheExcess) {
    EXPECT_EQ(kajiyaBound(0.2), 1);
    EXPECT_EQ(kajiyaBound(1), 1);
    EXPECT_DOUBLE_EQ(kajiyaBound(2.75), 1 / 2.75);
}

TEST(KajiyaKay, HighlightLiesOnTheMirrorCone) {
    const Vec3d tangent = Vec3d::UnitY();
    const Vec3d toLight = direction(0.7, 0);
    EXPECT_NEAR(kajiyaSpecular(tangent, toLight, direction(kPiDouble - 0.7, 2.5), 500), 1, 1e-9);
    EXPECT_LT(kajiyaSpecular(tangent, toLight, direction(0.7, 2.5), 500), 1e-3);
    EXPECT_NEAR(kajiyaSpecular(tangent, toLight, direction(kPiDouble - 0.9, 0), 1), std::cos(0.2), 1e-12);
    EXPECT_NEAR(kajiyaDiffuse(tangent, toLight), std::sin(0.7), 1e-12);
    EXPECT_EQ(kajiyaDiffuse(tangent, tangent), 0);
}

}  // namespace
}  // namespace hairloom::shading
