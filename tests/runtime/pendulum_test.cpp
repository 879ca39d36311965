// SPDX-License-Identifier: GPL-3.0-or-later
// A strand of one segment is a pendulum: what each integrator makes of it while its length is held, against
// the elliptic integral.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

constexpr double kLength = 0.5, kGravity = 39.24;
/// From the horizontal.
constexpr double kRelease = 0.5 * std::numbers::pi;

/// Angle to the vertical after `time` from rest at kRelease: with sin(θ/2) = k sin φ, k = sin(kRelease/2),
/// t √(g/l) = F(π/2, k) − F(φ, k).
double exactAngle(double time) {
    const double k = std::sin(0.5 * kRelease);
    const double left = std::ellint_1(k, 0.5 * std::numbers::pi) - time * std::sqrt(kGravity / kLength);
    double low = -0.5 * std::numbers::pi, high = -low;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (std::ellint_1(k, middle) < left ? low : high) = middle;
    }
    return 2.0 * std::asin(k * std::sin(low));
}

/// Distance of the tip, metres, after `time` in that many steps.
double errorAfter(Integrator integrator, double time, int steps) {
    Strands strands;
    strands.add({}, {1.0f, 0.0f, 0.0f}, static_cast<float>(kLength), 2);
    SimulationSettings s = bare();
    s.integrator = integrator;
    s.gravity = {0.0f, static_cast<float>(-kGravity), 0.0f};
    s.lengthIterations = 4;
    s.substeps = 1;
    Engine engine = makeEngine(strands, s);
    run(engine, strands, steps, static_cast<float>(time / steps));
    const Float3 tip = positionsOf(engine)[1];
    const double angle = exactAngle(time);
    return std::hypot(static_cast<double>(tip.x) - kLength * std::sin(angle),
                      static_cast<double>(tip.y) + kLength * std::cos(angle), static_cast<double>(tip.z));
}

struct PendulumCase {
    Integrator integrator;
    double order;
    double largest;  ///< metres, in the fewest steps
};
void PrintTo(const PendulumCase& c, std::ostream* out) {
    *out << nameOf(c.integrator);
}

class Pendulum : public testing::TestWithParam<PendulumCase> {};

/// Some 7/12 of a half swing. The steps end where errors come near to rounding.
TEST_P(Pendulum, HasTheOrderThatIsClaimedWithLengthsHeld) {
    const PendulumCase& c = GetParam();
    constexpr double kTime = 0.25;
    double before = 0.0;
    for (int steps = 15; steps <= 60; steps *= 2) {
        const double error = errorAfter(c.integrator, kTime, steps);
        if (before > 0.0) {
            std::printf("order %.2f\n", std::log2(before / error));
            EXPECT_NEAR(std::log2(before / error), c.order, 0.05) << steps;
        } else {
            EXPECT_LT(error, c.largest);
        }
        before = error;
    }
}

INSTANTIATE_TEST_SUITE_P(EveryIntegrator, Pendulum,
                         testing::Values(PendulumCase{Integrator::verlet, 2, 0.006},
                                         PendulumCase{Integrator::velocityVerlet, 2, 0.006},
                                         PendulumCase{Integrator::leapfrog, 0.93, 0.08},
                                         PendulumCase{Integrator::explicitEuler, 0.95, 0.05},
                                         PendulumCase{Integrator::implicitEuler, 0.86, 0.1},
                                         PendulumCase{Integrator::rk4, 2, 0.006}),
                         [](const auto& tested) { return std::string(nameOf(tested.param.integrator)); });

/// Started with the whole of a h² it would be off by half a step, 6.2 mm.
TEST(PendulumOfVerlet, StartsAtTheHalfStep) {
    EXPECT_LT(errorAfter(Integrator::verlet, 0.25, 120), 1.2e-4);
}

}  // namespace
}  // namespace hairloom::runtime
