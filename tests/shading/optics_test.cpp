// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/shading/cubic.h"
#include "core/shading/melanin.h"

namespace hairloom::shading {
namespace {

TEST(Optics, FresnelAcrossTheFibreIsThatOfTheTextbook) {
    const BravaisIndices indices = bravaisIndices(1.55, 0);
    EXPECT_NEAR(indices.perpendicular, 1.55, 1e-12);
    EXPECT_NEAR(indices.parallel, 1.55, 1e-12);
    EXPECT_NEAR(fresnel(indices, 1, 1), std::pow(0.55 / 2.55, 2), 1e-12);
    EXPECT_NEAR(fresnel(indices, 0, std::sqrt(1 - 1 / (1.55 * 1.55))), 1, 1e-12);
}

// Footnote 5 of the thesis prints the reciprocal, which falls below 1.
TEST(Optics, BravaisIndexGrowsWithInclination) {
    double before = 1.5;
    for (const double theta : {0.0, 0.3, 0.8, 1.2, 1.5}) {
        const double now = bravaisIndices(1.55, theta).perpendicular;
        EXPECT_GT(now, before);
        before = now;
    }
}

TEST(Optics, FresnelOfSkewRaysIsThatOfTheirAngleInSpace) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const double theta = 1.5 * random.uniformDouble();
        const double gamma = 1.55 * random.uniformDouble();
        const double ior = 1.1 + random.uniformDouble();
        const double outside = std::cos(theta) * std::cos(gamma);
        const double inside = std::sqrt(1 - (1 - outside * outside) / (ior * ior));
        const double s = (outside - ior * inside) / (outside + ior * inside);
        const double p = (ior * outside - inside) / (ior * outside + inside);
        const BravaisIndices indices = bravaisIndices(ior, theta);
        const double sineInside = std::sin(gamma) / indices.perpendicular;
        EXPECT_NEAR(fresnel(indices, std::cos(gamma), std::sqrt(1 - sineInside * sineInside)),
                    0.5 * (s * s + p * p), 1e-9);
    }
}

// Eq. 46 exchanges the two indices.
TEST(Optics, EachPolarisationHasItsOwnIndex) {
    const double sixty = std::numbers::pi / 3;
    const BravaisIndices indices = bravaisIndices(1.55, sixty);
    const double sineInside = std::sin(sixty) / indices.perpendicular;
    const double cosInside = std::sqrt(1 - sineInside * sineInside);
    EXPECT_NEAR(fresnel(indices, std::cos(sixty), cosInside), 0.273, 5e-4);
    const BravaisIndices printed{indices.parallel, indices.perpendicular};
    EXPECT_NEAR(fresnel(printed, std::cos(sixty), cosInside), 0.050, 5e-4);
}

TEST(Optics, PathInsideIsAnInclinedChord) {
    // Section 5.2 prints exp(−2σ cos γ_t) for all θ, and footnote 7 a chord of 2 cos 2γ_t.
    const Vec3d absorption(0.5, 1, 2);
    for (const double theta : {0.0, 0.5, 1.1}) {
        for (const double h : {0.0, 0.4, 0.95}) {
            const double sineInside = std::sin(theta) / 1.55;
            const double etaPrime = bravaisIndices(1.55, theta).perpendicular;
            const double way =
                2 * std::sqrt(1 - h * h / (etaPrime * etaPrime)) / std::sqrt(1 - sineInside * sineInside);
            const Vec3d t = CrossSection(1.55, theta, absorption).at(h).transmittance;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(t[c], std::exp(-absorption[c] * way), 1e-12);
        }
    }
    EXPECT_LT(CrossSection(1.55, 1.2, absorption).at(0).transmittance.x(),
              CrossSection(1.55, 0.2, absorption).at(0).transmittance.x());
}

TEST(Optics, AllPathsConserveEnergy) {
    for (const double theta : {0.0, 0.6, 1.3}) {
        for (const double h : {0.0, 0.5, 0.9, 0.999}) {
            const auto ray = CrossSection(1.55, theta, Vec3d::Zero()).at(h);
            EXPECT_NEAR(attenuation(ray, 0).x() + attenuation(ray, 1).x() + attenuationFrom(ray, 2).x(), 1,
                        1e-12);
            EXPECT_NEAR(attenuation(ray, 2).x() + attenuationFrom(ray, 3).x(), attenuationFrom(ray, 2).x(),
                        1e-12);
        }
    }
}

TEST(Cubic, FindsAllRealRoots) {
    Random random(8);
    int threes = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto number = [&] { return 4 * random.uniformDouble() - 2; };
        const double a = number(), b = number(), c = number();
        const RealRoots roots = solveCubic(a, b, c);
        const double p = b / a, q = c / a;
        ASSERT_EQ(roots.count, q * q / 4 + p * p * p / 27 > 0 ? 1 : 3);
        threes += roots.count == 3 ? 1 : 0;
        double product = 1;
        for (int k = 0; k < roots.count; ++k) {
            const double x = roots.x[static_cast<std::size_t>(k)];
            const double scale = std::abs(a * x * x * x) + std::abs(b * x) + std::abs(c);
            EXPECT_NEAR(a * x * x * x + b * x + c, 0, 1e-9 * scale);
            product *= x;
        }
        if (roots.count == 3) {
            EXPECT_NEAR(product, -q, 1e-9 * (1 + std::abs(q)));
        }
    }
    EXPECT_GT(threes, 200);
    EXPECT_EQ(solveCubic(0, 2, -1).x[0], 0.5);
    EXPECT_EQ(solveCubic(0, 0, 1).count, 0);
    EXPECT_EQ(solveCubic(1, 0, 0).x[0], 0);
}

TEST(Melanin, MatchesTheViewFiles) {
    // truth.md: blond has eumelanin 0.3.
    EXPECT_TRUE(absorption({0.3, 0}).isApprox(Vec3d(0.1257, 0.2091, 0.411), 1e-9));
    EXPECT_TRUE(absorption({0, 0.5}).isApprox(Vec3d(0.0935, 0.2, 0.525), 1e-9));
}

TEST(Melanin, RoughnessMatchesTheReference) {
    // truth.md: roughness 0.3 is β_R = 8.3 degrees in θ_h.
    EXPECT_NEAR(longitudinalWidth(0.3) * 180 / std::numbers::pi, 8.3, 0.05);
    EXPECT_NEAR(azimuthalWidth(0.3),
                0.6266571 * (0.265 * 0.3 + 1.194 * 0.09) * std::numbers::pi / std::sqrt(3.0), 1e-6);
}

TEST(Melanin, LighterColoursAbsorbLess) {
    const Vec3d dark = absorptionOfColour(Vec3d::Constant(0.1), 0.3);
    const Vec3d light = absorptionOfColour(Vec3d(0.9, 0.5, 1.0), 0.3);
    EXPECT_GT(dark.x(), light.x());
    EXPECT_GT(light.y(), light.x());
    EXPECT_EQ(light.z(), 0);
    EXPECT_TRUE(absorptionOfColour(Vec3d::Zero(), 0.3).allFinite());
}

TEST(Melanin, AxisRatioOfTheThesisGroups) {
    EXPECT_EQ(axisRatio(0), 1);
    EXPECT_NEAR(axisRatio(0.67), 1.347, 1e-3);
}

}  // namespace
}  // namespace hairloom::shading
