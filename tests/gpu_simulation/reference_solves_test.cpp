// SPDX-License-Identifier: GPL-3.0-or-later
// One substep of what is solved, and of the integrators besides Verlet, beside double precision: the step of
// implicit springs by a dense matrix, bending and lengths as one system by Newton's method, and the
// integrators' own formulas with the forces of core/simulation/reference.
#include <Eigen/Dense>
#include <cmath>

#include "tests/gpu_simulation/reference_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): the fixture is made for these cases
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStepSquared = kSubstep * kSubstep;

Places sumOf(const Places& a, const Places& b, double share = 1.0) {
    Places sum = a;
    for (std::size_t p = 0; p < a.size(); ++p) sum[p] += b[p] * share;
    return sum;
}

VectorXd stacked(const Places& places) {
    VectorXd all(3 * static_cast<Index>(places.size()));
    for (std::size_t p = 0; p < places.size(); ++p) all.segment<3>(3 * static_cast<Index>(p)) = places[p];
    return all;
}

/// docs/engine.md, "Integrators": (M + (¼ + q) h² K) δ = h² (force at x + q u, in the frames at x), for the
/// free points.
struct BendSystem {
    MatrixXd matrix;
    VectorXd right;
    Index first;  ///< row of the first free point in that of all points

    BendSystem(const Bodies& bodies, std::size_t s, const Strand& before, bool curled) {
        const SimulationSettings& settings = bodies.settings();
        const double minimum = curled ? 0.25 : settings.bendDampingTime > 0.0f ? 0.02 : 0.0;
        const double rate = std::max(static_cast<double>(settings.bendDampingTime) / kSubstep, minimum);
        reference::Physics physics(settings);
        physics.bendDampingTime = 0.0;
        const MatrixXd stiffness = bodies.stiffness(s, before.places);
        const Places still(before.places.size(), Vector3d::Zero());
        const VectorXd force = stacked(bodies.forces(s, before.places, still, physics));
        const VectorXd ahead = force - stiffness * stacked(before.moved) * rate;
        first = 3 * static_cast<Index>(settings.clampedPoints);
        const Index rows = force.size() - first;
        matrix = (0.25 + rate) * kStepSquared * stiffness.bottomRightCorner(rows, rows);
        for (Index row = 0; row < rows; ++row)
            matrix(row, row) += bodies.shape(s).masses[static_cast<std::size_t>((first + row) / 3)];
        right = kStepSquared * ahead.tail(rows);
    }
};

SimulationSettings springs(float stiffness, float damping) {
    SimulationSettings s = nothing();
    s.angularStiffness = stiffness;
    s.angularMethod = runtime::AngularMethod::implicit;
    s.bendDampingTime = damping;
    return s;
}

class ReferenceSolves : public Reference {};

TEST_F(ReferenceSolves, ImplicitSpringsByADenseMatrix) {
    for (const Hair hair : {Hair::straight, Hair::curled}) {
        for (const float stiffness : {0.3f, 0.95f}) {
            SCOPED_TRACE(static_cast<int>(hair) + 10.0 * static_cast<double>(stiffness));
            const SimulationSettings settings = springs(stiffness, 0.003f);
            const Scene scene = sceneFor(settings, hair, false, 0);
            const Bodies bodies(scene, settings);
            const auto groundTruth = [&](std::size_t s, const Strand& before) {
                const BendSystem system(bodies, s, before, hair == Hair::curled);
                const VectorXd move = system.matrix.ldlt().solve(system.right);
                Places x = sumOf(before.places, before.moved);
                for (std::size_t p = settings.clampedPoints; p < x.size(); ++p)
                    x[p] += move.segment<3>(3 * static_cast<Index>(p) - system.first);
                return x;
            };
            hold(scene, groundTruth, placesOf, 0.0);
        }
    }
}

/// The places after one substep of the coupled system: the same matrix, and on the right the tension λ of
/// each segment along it as it was at the start, such that all lengths are right. Newton's method on both.
Places coupledInDouble(const Bodies& bodies, std::size_t s, const Strand& before, bool curled) {
    const BendSystem system(bodies, s, before, curled);
    const reference::StrandShape& shape = bodies.shape(s);
    const auto firstSegment = static_cast<Index>(bodies.settings().clampedPoints) - 1;
    const Index rows = system.right.size(), segments = static_cast<Index>(shape.segments()) - firstSegment;
    const Places free = sumOf(before.places, before.moved);
    VectorXd unknown = VectorXd::Zero(rows + segments);
    Places x = free;
    for (int iteration = 0; iteration < 30; ++iteration) {
        MatrixXd jacobian = MatrixXd::Zero(rows + segments, rows + segments);
        jacobian.topLeftCorner(rows, rows) = system.matrix;
        VectorXd residual(rows + segments);
        residual.head(rows) = system.matrix * unknown.head(rows) - system.right;
        for (Index j = 0; j < segments; ++j) {
            const auto inner = static_cast<std::size_t>(firstSegment + j);
            const double length = shape.lengths[inner], tension = unknown[rows + j];
            const Vector3d along = (before.places[inner + 1] - before.places[inner]) / length;
            const Vector3d edge = x[inner + 1] - x[inner];
            residual[rows + j] = 0.5 * (edge.squaredNorm() / length - length);
            const Index outerRow = 3 * j, innerRow = outerRow - 3;
            residual.segment<3>(outerRow) += along * tension;
            jacobian.block<3, 1>(outerRow, rows + j) = along;
            jacobian.block<1, 3>(rows + j, outerRow) = edge.transpose() / length;
            if (j == 0) continue;
            residual.segment<3>(innerRow) -= along * tension;
            jacobian.block<3, 1>(innerRow, rows + j) = -along;
            jacobian.block<1, 3>(rows + j, innerRow) = -edge.transpose() / length;
        }
        unknown -= jacobian.fullPivLu().solve(residual);
        for (Index row = 0; row < rows; row += 3) {
            const auto p = static_cast<std::size_t>((system.first + row) / 3);
            x[p] = free[p] + unknown.segment<3>(row);
        }
        if (residual.norm() < 1e-15) break;
    }
    return x;
}

/// The method of multipliers stops where lengths are wrong by 3·10⁻⁷ of them and 2.4·10⁻⁷ of places, about
/// 5·10⁻⁸ m. Across a segment that turns by 3·10⁻³ a place that far off in length is off by 2·10⁻⁵ m, of the
/// 2·10⁻⁴ that points move here. In two of 1,280 strands such segments add up to 3.3·10⁻⁵.
TEST_F(ReferenceSolves, BendingAndLengthsByNewtonsMethod) {
    for (const Hair hair : {Hair::straight, Hair::curled}) {
        SCOPED_TRACE(static_cast<int>(hair));
        SimulationSettings settings = springs(0.3f, 0.0f);
        settings.lengthIterations = 1;
        settings.maximalExtension = 0.48f;
        constexpr float kGently = 5e-5f;
        const Scene scene = sceneFor(settings, hair, false, 0, kGently);
        const Bodies bodies(scene, settings);
        const std::vector<Strand> before = strandsOf(scene, scene.state);
        StrandEngine engine = engineOf(scene.view(), scene.settings, options());
        ASSERT_TRUE(engine.writeState(scene.state));
        ASSERT_TRUE(engine.step(scene.input()));
        ASSERT_TRUE(engine.plan().on(runtime::Effect::coupling));
        const std::vector<Strand> gpu = strandsOf(scene, engine.readState().value());
        const std::vector<Strand> cpu = strandsOf(scene, runOnCpu(scene));
        std::size_t far = 0;
        for (std::size_t s = 0; s < before.size(); ++s) {
            const Places exact = coupledInDouble(bodies, s, before[s], hair == Hair::curled);
            const double off = std::max(farthest(gpu[s].places, exact, settings.clampedPoints),
                                        farthest(cpu[s].places, exact, settings.clampedPoints));
            if (off > 2e-5) ++far;
            EXPECT_LE(off, 6e-5) << "strand " << s;
            for (std::size_t j = settings.clampedPoints - 1; j < bodies.shape(s).segments(); ++j) {
                const Places& places = gpu[s].places;
                const double length = bodies.shape(s).lengths[j];
                EXPECT_NEAR((places[j + 1] - places[j]).norm(), length,
                            1e-6 * length + 5e-7 * places[j].lpNorm<1>());
            }
        }
        EXPECT_LE(far, 1u);
    }
}

/// Where a substep ends.
struct Ended {
    Places places, moved;
};
/// Displacements that forces add at places, for displacements that stand for velocity.
using Kick = std::function<Places(const Places& places, const Places& moved)>;

// Equations 7 to 12 of Rünz 2012 and the classical Runge-Kutta method, for displacements u = v h and a h².
Ended explicitEuler(const Kick& kick, const Places& x, const Places& u) {
    return {sumOf(x, u), sumOf(u, kick(x, u))};
}
Ended leapfrog(const Kick& kick, const Places& x, const Places& u) {
    const Places half = sumOf(x, u, 0.5), after = sumOf(u, kick(half, u));
    return {sumOf(half, after, 0.5), after};
}
Ended velocityVerlet(const Kick& kick, const Places& x, const Places& u) {
    const Places half = sumOf(u, kick(x, u), 0.5), end = sumOf(x, half);
    const Places predicted = sumOf(sumOf(half, half), u, -1.0);
    return {end, sumOf(half, kick(end, predicted), 0.5)};
}
Ended rungeKutta(const Kick& kick, const Places& x, const Places& u) {
    const Places a1 = kick(x, u), u2 = sumOf(u, a1, 0.5);
    const Places a2 = kick(sumOf(x, u, 0.5), u2), u3 = sumOf(u, a2, 0.5);
    const Places a3 = kick(sumOf(x, u2, 0.5), u3), u4 = sumOf(u, a3);
    const Places a4 = kick(sumOf(x, u3), u4);
    const auto mean = [](const Places& k1, const Places& k2, const Places& k3, const Places& k4) {
        Places sum = k1;
        for (std::size_t p = 0; p < sum.size(); ++p) sum[p] = (k1[p] + 2.0 * (k2[p] + k3[p]) + k4[p]) / 6.0;
        return sum;
    };
    return {sumOf(x, mean(u, u2, u3, u4)), sumOf(u, mean(a1, a2, a3, a4))};
}

struct Rule {
    const char* name;
    runtime::Integrator integrator;
    Ended (*step)(const Kick& kick, const Places& x, const Places& u);
};

void PrintTo(const Rule& printed, std::ostream* out) {
    *out << printed.name;
}

constexpr Rule kRules[] = {{"explicitEuler", runtime::Integrator::explicitEuler, explicitEuler},
                           {"leapfrog", runtime::Integrator::leapfrog, leapfrog},
                           {"velocityVerlet", runtime::Integrator::velocityVerlet, velocityVerlet},
                           {"rk4", runtime::Integrator::rk4, rungeKutta}};

class ReferenceIntegrators : public Reference, public testing::WithParamInterface<Rule> {};

TEST_P(ReferenceIntegrators, StepAsTheirFormulas) {
    SimulationSettings settings = nothing();
    settings.integrator = GetParam().integrator;
    settings.gravity = {1.0f, -9.81f, 0.5f};
    settings.airDrag = 5.0f;
    settings.lengthMethod = runtime::LengthMethod::springs;
    settings.springFrequency = 20.0f;
    settings.angularStiffness = 0.3f;
    settings.angularMethod = runtime::AngularMethod::smallAngle;
    settings.restGravity = 0.0f;
    const Scene scene = sceneFor(settings, Hair::curled, false, 0);
    const Bodies bodies(scene, settings);
    const reference::Physics physics(settings);
    const auto ended = [&](std::size_t s, const Strand& before) {
        const auto kick = [&](const Places& places, const Places& moved) {
            Places added = bodies.added(s, places, moved, physics);
            for (std::size_t p = 0; p < settings.clampedPoints; ++p) added[p].setZero();
            return added;
        };
        return GetParam().step(kick, before.places, before.moved);
    };
    const auto places = [&](std::size_t s, const Strand& before) { return ended(s, before).places; };
    const auto moved = [&](std::size_t s, const Strand& before) { return ended(s, before).moved; };
    hold(scene, places, placesOf, 1e-5);
    hold(scene, moved, movesOf, 1e-4);
}
INSTANTIATE_TEST_SUITE_P(Rules, ReferenceIntegrators, testing::ValuesIn(kRules),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace hairloom::gpu_simulation
