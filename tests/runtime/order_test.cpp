// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of convergence, measured: a strand of coil springs and small-angle springs that gravity sets in
// motion from rest, against the model in double precision.
#include <Eigen/Core>
#include <cstdio>
#include <string>

#include "tests/runtime/smooth_strand.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

constexpr int kFineSteps = 400;
constexpr float kSegment = 0.1f;
constexpr std::uint32_t kPoints = 6;
const Float3 kDirection{0.6f, 0.0f, 0.8f};

/// Soft springs, so that truncation stands far above the rounding of single precision at few steps.
SimulationSettings smoothScene(Integrator integrator, AngularMethod method, float airDrag) {
    SimulationSettings s = bare();
    s.integrator = integrator;
    s.angularMethod = method;
    s.angularStiffness = 0.96f;
    s.angularCurve = {};
    s.bendDampingTime = 0.0f;
    s.restGravity = 0.0f;
    s.lengthMethod = LengthMethod::springs;
    s.lengthIterations = 0;
    s.springFrequency = 8.0f;
    s.clampedPoints = 2;
    s.substeps = 1;
    s.airDrag = airDrag;
    s.gravity = {32.0f, -157.0f, 64.0f};
    return s;
}

/// Root mean squares over the points, in metres and metres per second.
struct Error {
    double positions = 0.0, speeds = 0.0;
};

double distance(std::span<const Float3> a, const Eigen::Matrix3Xd& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Eigen::Vector3d there(static_cast<double>(a[i].x), static_cast<double>(a[i].y),
                                    static_cast<double>(a[i].z));
        sum += (there - b.col(static_cast<Eigen::Index>(i))).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// From rest to `time` in that many steps.
Error errorAfter(const SimulationSettings& settings, double time, int steps) {
    Strands strands;
    strands.add({}, kDirection, kSegment, kPoints);
    Engine engine = makeEngine(strands, settings);
    run(engine, strands, steps, static_cast<float>(time / steps));
    std::vector<Float3> velocities(engine.pointCount());
    engine.readVelocities(velocities);

    // Position Verlet keeps the velocity of half a step ago.
    const double late = settings.integrator == Integrator::verlet ? 0.5 * time / steps : 0.0;
    const test::SmoothStrand model(settings, {0.6, 0.0, 0.8}, static_cast<double>(kSegment), kPoints);
    const auto places = model.afterRest(time, kFineSteps), speeds = model.afterRest(time - late, kFineSteps);
    return {distance(positionsOf(engine), places.positions), distance(velocities, speeds.velocities)};
}

struct OrderCase {
    const char* name;
    Integrator integrator;
    AngularMethod method;
    float airDrag;  ///< 1/s
    int order;
    double time;   ///< seconds; before any point turns round, where drag has a kink
    int steps;     ///< the coarsest, no longer than a usual frame; two halvings follow
    double floor;  ///< metres: no error may lie below, where rounding (about 1e-6) would be measured
};

void PrintTo(const OrderCase& c, std::ostream* out) {
    *out << c.name;
}

class Order : public testing::TestWithParam<OrderCase> {};

TEST_P(Order, IsThatOfTheTextbook) {
    const OrderCase& c = GetParam();
    const SimulationSettings settings = smoothScene(c.integrator, c.method, c.airDrag);
    std::vector<double> positions, speeds;
    for (int halving = 0; halving < 3; ++halving) {
        const Error error = errorAfter(settings, c.time, c.steps << halving);
        positions.push_back(error.positions);
        speeds.push_back(error.speeds);
    }
    EXPECT_GT(positions.back(), c.floor) << "rounding would be measured";
    EXPECT_LT(positions.front(), 0.05) << "too coarse for an order to show";
    for (std::size_t i = 1; i < positions.size(); ++i) {
        const double ofPositions = std::log2(positions[i - 1] / positions[i]);
        const double ofSpeeds = std::log2(speeds[i - 1] / speeds[i]);
        std::printf("order %.2f of places, %.2f of speeds\n", ofPositions, ofSpeeds);
        EXPECT_NEAR(ofPositions, c.order, 0.25) << positions[i - 1] << " m, then " << positions[i];
        // Speeds show their order one halving later than positions.
        if (i + 1 == positions.size()) {
            EXPECT_NEAR(ofSpeeds, c.order, 0.25) << speeds[i - 1] << " m/s, then " << speeds[i];
        }
    }
}

constexpr AngularMethod kSmallAngle = AngularMethod::smallAngle;
constexpr AngularMethod kImplicit = AngularMethod::implicit;
constexpr AngularMethod kExact = AngularMethod::exact;

INSTANTIATE_TEST_SUITE_P(
    Smooth, Order,
    testing::Values(
        OrderCase{"explicitEuler", Integrator::explicitEuler, kSmallAngle, 0.0f, 1, 0.1, 64, 1e-4},
        OrderCase{"implicitEuler", Integrator::implicitEuler, kSmallAngle, 0.0f, 1, 0.1, 64, 1e-4},
        OrderCase{"verletSmallAngle", Integrator::verlet, kSmallAngle, 0.0f, 2, 0.1, 12, 1e-5},
        OrderCase{"verletImplicit", Integrator::verlet, kImplicit, 0.0f, 2, 0.1, 12, 1e-5},
        OrderCase{"velocityVerlet", Integrator::velocityVerlet, kSmallAngle, 0.0f, 2, 0.1, 12, 1e-5},
        OrderCase{"velocityVerletExact", Integrator::velocityVerlet, kExact, 0.0f, 2, 0.1, 12, 1e-5},
        OrderCase{"leapfrog", Integrator::leapfrog, kSmallAngle, 0.0f, 2, 0.1, 12, 1e-5},
        OrderCase{"rk4", Integrator::rk4, kSmallAngle, 0.0f, 4, 0.125, 8, 3e-6},
        OrderCase{"rk4Exact", Integrator::rk4, kExact, 0.0f, 4, 0.125, 8, 3e-6}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// Drag is a force of the velocity. Position Verlet and leapfrog give it that of half a step ago and of the
/// step's start, which costs them an order; velocity Verlet predicts the velocity and keeps its order.
INSTANTIATE_TEST_SUITE_P(
    WithDrag, Order,
    testing::Values(
        OrderCase{"explicitEuler", Integrator::explicitEuler, kSmallAngle, 20.0f, 1, 0.1, 64, 1e-4},
        OrderCase{"implicitEuler", Integrator::implicitEuler, kSmallAngle, 20.0f, 1, 0.1, 64, 1e-4},
        OrderCase{"verlet", Integrator::verlet, kSmallAngle, 20.0f, 1, 0.1, 64, 1e-4},
        OrderCase{"velocityVerlet", Integrator::velocityVerlet, kSmallAngle, 20.0f, 2, 0.1, 12, 1e-5},
        OrderCase{"leapfrog", Integrator::leapfrog, kSmallAngle, 20.0f, 1, 0.1, 64, 1e-4},
        OrderCase{"rk4", Integrator::rk4, kSmallAngle, 20.0f, 4, 0.125, 8, 3e-6}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace hairloom::runtime
