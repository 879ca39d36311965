// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/sadeghi.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;

SadeghiParameters onlyOne(Lobe lobe) {
    SadeghiParameters parameters;
    SadeghiLobe& l = lobe == Lobe::R ? parameters.r : lobe == Lobe::TT ? parameters.tt : parameters.trt;
    l.intensity = 0.7;
    l.colour = Vec3d(1, 0.5, 0.25);
    l.shift = -3 * kDegree;
    l.width = 0.2;
    return parameters;
}

TEST(Sadeghi, HighlightsSitOppositeTheLightMovedByTheShift) {
    // Eq. 52 prints θ_d, with which this highlight would follow the view.
    SadeghiParameters p = onlyOne(Lobe::R);
    p.bounded = false;
    const double in = 0.3;
    const Vec3d peak = evaluate(p, in, -in - 6 * kDegree, 0, 0);
    const double cosine = std::cos(0.5 * (-2 * in - 6 * kDegree));
    EXPECT_TRUE((peak * cosine * cosine).isApprox(0.7 * Vec3d(1, 0.5, 0.25), 1e-12));
    EXPECT_LT(SadeghiLongitudinal(p)(Lobe::R, in, in), 1e-3);
}

TEST(Sadeghi, GaussiansHaveTheHeightOneWhateverTheirWidth) {
    for (const double width : {0.05, 0.3, 1.0}) {
        EXPECT_EQ(unitHeightGauss(0, width), 1);
        double area = 0;
        for (int i = -10000; i < 10000; ++i) area += unitHeightGauss((i + 0.5) * 1e-3, width) * 1e-3;
        EXPECT_NEAR(area, width, 1e-9);
    }
}

TEST(Sadeghi, LobesHaveTheirPlacesAroundTheFibre) {
    const SadeghiParameters p = onlyOne(Lobe::TRT);
    EXPECT_EQ(sadeghiAzimuthal(p, Lobe::R, 0, 0), 1);
    EXPECT_NEAR(sadeghiAzimuthal(p, Lobe::R, kPi, 0), 0, 1e-12);
    EXPECT_EQ(sadeghiAzimuthal(p, Lobe::TT, kPi, 0), 1);
    EXPECT_EQ(sadeghiAzimuthal(p, Lobe::TT, -kPi, 0), 1);
    EXPECT_NEAR(sadeghiAzimuthal(p, Lobe::TRT, 30 * kDegree, 0), std::cos(15 * kDegree) + 0.5, 1e-12);
    EXPECT_NEAR(sadeghiAzimuthal(p, Lobe::TRT, -45 * kDegree, 1), std::cos(22.5 * kDegree) + 0.5, 1e-12);
    EXPECT_LT(sadeghiAzimuthal(p, Lobe::TRT, 45 * kDegree, 0), std::cos(22.5 * kDegree) + 0.01);
}

TEST(Sadeghi, EachControlMovesItsOwnLobeAlone) {
    SadeghiParameters base = sadeghiLike(Marschner(MarschnerParameters{}));
    base.bounded = false;  // a louder lobe would quieten the others
    const Vec3d forward = evaluate(base, 0.2, -0.2, kPi, 0.5);
    base.r.intensity *= 2;
    base.trt.intensity *= 3;
    base.glintIntensity = 4;
    EXPECT_TRUE(evaluate(base, 0.2, -0.2, kPi, 0.5).isApprox(forward, 0.02));
    base.tt.intensity *= 2;
    EXPECT_GT(evaluate(base, 0.2, -0.2, kPi, 0.5).x(), 1.9 * forward.x());
    base.tt.colour = Vec3d(1, 0, 0);
    EXPECT_LT(evaluate(base, 0.2, -0.2, kPi, 0.5).y(), 0.05 * evaluate(base, 0.2, -0.2, kPi, 0.5).x());
}

/// What leaves the fibre of light that comes from one direction, or towards one view of even light from
/// around: the brightest channel, by the midpoint rule over the sphere.
double lightOf(const SadeghiParameters& p, double theta, bool ofView, double glint) {
    const SadeghiLongitudinal longitudinal(p);
    constexpr int kThetas = 600, kPhis = 180;
    std::array<double, 3> around{};
    for (int i = 0; i < kPhis; ++i) {
        const double phi = (i + 0.5) * 2 * kPi / kPhis;
        for (const Lobe lobe : kLobes)
            around[index(lobe)] += sadeghiAzimuthal(p, lobe, phi, glint) * 2 * kPi / kPhis;
    }
    Vec3d sum = Vec3d::Zero();
    for (int i = 0; i < kThetas; ++i) {
        const double other = ((i + 0.5) / kThetas - 0.5) * kPi;
        const double in = ofView ? other : theta, out = ofView ? theta : other;
        const double cosD = std::cos(0.5 * (out - in));
        // S cos of the integrated side, and the solid angle's cosine.
        const double factor = std::cos(other) * std::cos(other) / (cosD * cosD) * kPi / kThetas;
        for (const Lobe lobe : kLobes)
            sum += factor * longitudinal(lobe, in, out) * around[index(lobe)] * p.lobe(lobe).light();
    }
    return sum.maxCoeff();
}

SadeghiParameters whiteHair() {
    MarschnerParameters m;
    m.azimuthal.absorption = Vec3d::Zero();
    m.azimuthal.width = 0.2;
    return sadeghiLike(Marschner(m));
}

TEST(Sadeghi, SendsOutNoMoreThanItGetsFromAndTowardsAnyDirection) {
    SadeghiParameters loud = whiteHair();
    loud.r.intensity *= 4;
    loud.tt.width *= 3;
    loud.trt.tint = Vec3d(0.2, 1, 0.2);
    loud.trt.shift = -20 * kDegree;
    loud.glintIntensity = 8;
    for (const SadeghiParameters& p : {whiteHair(), loud}) {
        for (int degrees = -89; degrees <= 89; degrees += 4) {
            EXPECT_LE(lightOf(p, degrees * kDegree, false, 0.5), 1.006) << degrees;
            EXPECT_LE(lightOf(p, degrees * kDegree, true, 0.5), 1.006) << degrees;
        }
    }
    SadeghiParameters published = whiteHair();
    published.bounded = false;
    double most = 0;
    for (int degrees = -89; degrees <= 89; ++degrees)
        most = std::max(most, lightOf(published, degrees * kDegree, true, 0.5));
    EXPECT_GT(most, 1.4) << "what the bound is for";
}

TEST(Sadeghi, LobesKeepTheirLightAtAnyInclination) {
    SadeghiParameters p = whiteHair();
    for (int degrees = -40; degrees <= 40; degrees += 10) {
        EXPECT_GT(lightOf(p, degrees * kDegree, false, 0.5), 0.95) << degrees;
        EXPECT_GT(lightOf(p, degrees * kDegree, true, 0.5), 0.93) << degrees;
    }
    // A lobe sends out its height times its widths, from every side: the printed one up to half as much
    // again.
    for (SadeghiLobe* lobe : {&p.r, &p.tt}) lobe->intensity = 0;
    p.trt.intensity *= 0.3;
    const double around = 4 + 2 * p.glintIntensity * p.glintWidth;
    const double expected = p.trt.light().maxCoeff() * 2 * p.trt.width * around;
    for (int degrees = -70; degrees <= 70; degrees += 10)
        EXPECT_NEAR(lightOf(p, degrees * kDegree, false, 0.5), expected, 0.01 * expected) << degrees;
}

TEST(Sadeghi, StartsFromMarschnersEnergies) {
    MarschnerParameters m;
    m.azimuthal.absorption = Vec3d(0.2, 0.4, 0.8);
    m.azimuthal.width = 0.2;
    const Marschner model(m);
    const SadeghiParameters s = sadeghiLike(model);
    for (const Lobe lobe : kLobes) {
        Vec3d around = Vec3d::Zero();
        for (int i = 0; i < 720; ++i) {
            const double phi = (i + 0.5) * kPi / 360 - kPi;
            around += s.lobe(lobe).colour * (s.lobe(lobe).intensity * 2 * s.lobe(lobe).width *
                                             sadeghiAzimuthal(s, lobe, phi, 0.5) * kPi / 360);
        }
        EXPECT_TRUE(around.isApprox(model.azimuthal(0).energy(lobe), 0.02)) << order(lobe);
        EXPECT_EQ(s.lobe(lobe).shift, m.tilt[index(lobe)]);
    }
}

}  // namespace
}  // namespace hairloom::shading
