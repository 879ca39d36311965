// SPDX-License-Identifier: GPL-3.0-or-later
// Loss of angular momentum: what is known of each method without it.
#include "core/stability/angular_momentum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/spring_settings.h"

namespace hairloom {
namespace {

using runtime::AngularMethod;
using runtime::Integrator;

double lossOf(const runtime::SimulationSettings& settings) {
    const auto loss = angularMomentumLoss(settings);
    EXPECT_TRUE(loss.has_value()) << loss.error().message();
    return loss ? loss->lost : NAN;
}

/// A point on a rigid rod of length 1 that backward Euler moves: found by bisection of the rod's force,
/// without the formula.
double rigidLoss(double rate, double h, double seconds) {
    double x = 1, y = 0, vx = 0, vy = rate;
    for (double t = 0; t < seconds - 0.5 * h; t += h) {
        double low = 0, high = 0.5 / (h * h);  // force per length: v' = v − h f x', x' = x + h v'
        for (int i = 0; i < 200; ++i) {
            const double f = 0.5 * (low + high), scale = 1 / (1 + h * h * f);
            const double nx = (x + h * vx) * scale, ny = (y + h * vy) * scale;
            (std::hypot(nx, ny) > 1 ? low : high) = f;
        }
        const double scale = 1 / (1 + h * h * low);
        const double nx = (x + h * vx) * scale, ny = (y + h * vy) * scale;
        vx = (nx - x) / h, vy = (ny - y) / h;
        x = nx, y = ny;
    }
    return 1 - (x * vy - y * vx) / rate;
}

TEST(AngularMomentum, TheFormulaIsThatOfARigidSpin) {
    for (const double h : {1.0 / 120, 1.0 / 480, 1.0 / 1920}) {
        const double found = rigidLoss(10, h, 1);
        EXPECT_NEAR(backwardEulerLoss(10, h, 1), found, 0.06 * found) << h;
    }
}

TEST(AngularMomentum, BackwardEulerLosesWhatTheFormulaSays) {
    runtime::SimulationSettings s = runtime::springSettings();
    s.integrator = Integrator::implicitEuler;
    s.angularMethod = AngularMethod::smallAngle;
    for (const std::uint32_t substeps : {2u, 4u, 8u}) {
        s.substeps = substeps;
        const auto loss = angularMomentumLoss(s);
        ASSERT_TRUE(loss.has_value());
        EXPECT_GT(loss->rate, 5);
        EXPECT_NEAR(loss->lost, loss->predicted, 0.12 * loss->predicted) << substeps;
    }
}

TEST(AngularMomentum, CentralForcesOfExplicitStepsKeepIt) {
    runtime::SimulationSettings s = runtime::springSettings();
    s.angularMethod = AngularMethod::flexion;
    for (const std::uint32_t substeps : {8u, 32u}) {
        s.substeps = substeps;
        EXPECT_NEAR(lossOf(s), 0, 3e-3) << substeps;
    }
}

TEST(AngularMomentum, RodsLoseLessThanBackwardEulerAndLessWithSubsteps) {
    runtime::SimulationSettings s;
    s.substeps = 2;
    const auto few = angularMomentumLoss(s);
    ASSERT_TRUE(few.has_value());
    EXPECT_LT(few->lost, 0.5 * few->predicted);
    s.substeps = 16;
    EXPECT_LT(std::abs(lossOf(s)), 0.02);
}

TEST(AngularMomentum, SettingsOutOfRangeAreRefused) {
    runtime::SimulationSettings s;
    s.angularStiffness = 2;
    EXPECT_FALSE(angularMomentumLoss(s).has_value());
}

}  // namespace
}  // namespace hairloom
