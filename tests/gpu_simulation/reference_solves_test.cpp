// SPDX-License-Identifier: GPL-3.0-or-later
// One substep of what is solved, and of the integrators besides Verlet, beside double precision: the step of
// implicit springs by a dense matrix, bending and lengths as one system by Newton's method, and the
// integrators' own formulas with the forces of core/simulation/reference.
#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/gpu_simulation/reference_fixture.h"

namespace hairloom::gpu_simulation {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): the fixture is made for these cases
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStepSquared = kSubstep * kSubstep;

Positions sumOf(const Positions& a, const Positions& b, double share = 1.0) {
    Positions sum = a;
    for (std::size_t p = 0; p < a.size(); ++p) sum[p] += b[p] * share;
    return sum;
}

VectorXd stacked(const Positions& positions) {
    VectorXd all(3 * static_cast<Index>(positions.size()));
    for (std::size_t p = 0; p < positions.size(); ++p)
        all.segment<3>(3 * static_cast<Index>(p)) = positions[p];
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
        const MatrixXd stiffness = bodies.stiffness(s, before.positions);
        const Positions still(before.positions.size(), Vector3d::Zero());
        const VectorXd force = stacked(bodies.forces(s, before.positions, still, physics));
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
                Positions x = sumOf(before.positions, before.moved);
                for (std::size_t p = settings.clampedPoints; p < x.size(); ++p)
                    x[p] += move.segment<3>(3 * static_cast<Index>(p) - system.first);
                return x;
            };
            hold(scene, groundTruth, positionsOf, 0.0);
        }
    }
}

/// One linearised step of backward Euler (Rünz 2012, Eq. 9, as Baraff and Witkin 1998): (M − h² ∂f/∂x) d =
/// M u + h² f, densely, without the part of a coil's Jacobian that pushes across it (Choi and Ko 2002).
Positions backwardEuler(const Bodies& bodies, const Bodies& bending, std::size_t s, const Strand& before) {
    const SimulationSettings& settings = bodies.settings();
    const Positions& x = before.positions;
    const std::vector<double>& masses = bodies.shape(s).masses;
    const auto points = static_cast<Index>(x.size());
    MatrixXd matrix = kStepSquared * bending.stiffness(s, x);
    if (settings.lengthMethod != runtime::LengthMethod::constraint) {
        const double rate = 2.0 * std::numbers::pi * static_cast<double>(settings.springFrequency);
        for (Index j = 0; j + 1 < points; ++j) {
            const auto a = static_cast<std::size_t>(j);
            const Vector3d edge = x[a + 1] - x[a], along = edge.normalized();
            const double k = kStepSquared * rate * rate * 2.0 / (1.0 / masses[a] + 1.0 / masses[a + 1]);
            const double across = std::max(1.0 - bodies.shape(s).lengths[a] / edge.norm(), 0.0);
            const Eigen::Matrix3d block =
                k * (across * Eigen::Matrix3d::Identity() + (1.0 - across) * along * along.transpose());
            matrix.block<3, 3>(3 * j, 3 * j) += block;
            matrix.block<3, 3>(3 * j + 3, 3 * j + 3) += block;
            matrix.block<3, 3>(3 * j, 3 * j + 3) -= block;
            matrix.block<3, 3>(3 * j + 3, 3 * j) -= block;
        }
    }
    for (Index row = 0; row < 3 * points; ++row)
        matrix(row, row) += masses[static_cast<std::size_t>(row / 3)];
    const Positions still(x.size(), Vector3d::Zero());
    const Positions force = bodies.forces(s, x, still, reference::Physics(settings));
    VectorXd right = kStepSquared * stacked(force);
    for (Index row = 0; row < right.size(); ++row)
        right(row) += masses[static_cast<std::size_t>(row / 3)] * stacked(before.moved)(row);
    const Index first = 3 * static_cast<Index>(settings.clampedPoints), rows = 3 * points - first;
    const VectorXd moved = matrix.bottomRightCorner(rows, rows).ldlt().solve(right.tail(rows));
    Positions end = x;
    for (std::size_t p = settings.clampedPoints; p < end.size(); ++p)
        end[p] += moved.segment<3>(3 * static_cast<Index>(p) - first);
    return end;
}

struct Backward {
    const char* name;
    runtime::LengthMethod lengths;
    float springFrequency;  ///< Hz
    float angularStiffness;
    std::uint32_t clampedPoints;
};
void PrintTo(const Backward& printed, std::ostream* out) {
    *out << printed.name;
}
using runtime::LengthMethod;
constexpr Backward kBackward[] = {
    {"nothingStiff", LengthMethod::constraint, 1.0f, 0.0f, 2},
    {"angular", LengthMethod::constraint, 1.0f, 0.3f, 2},
    {"angularStiff", LengthMethod::constraint, 1.0f, 0.95f, 1},
    {"coils", LengthMethod::springs, 200.0f, 0.0f, 2},
    {"coilsAndAngular", LengthMethod::springs, 200.0f, 0.3f, 2},
};

class ReferenceBackwardEuler : public Reference, public testing::WithParamInterface<Backward> {};

TEST_P(ReferenceBackwardEuler, ByADenseMatrix) {
    SimulationSettings settings = nothing();
    settings.integrator = runtime::Integrator::implicitEuler;
    settings.gravity = {1.0f, -9.81f, 0.5f};
    settings.lengthMethod = GetParam().lengths;
    settings.springFrequency = GetParam().springFrequency;
    settings.angularStiffness = GetParam().angularStiffness;
    settings.clampedPoints = GetParam().clampedPoints;
    settings.angularMethod = runtime::AngularMethod::smallAngle;
    settings.restGravity = 0.0f;
    SimulationSettings bent = settings;
    bent.lengthMethod = runtime::LengthMethod::constraint;
    for (const Hair hair : {Hair::straight, Hair::curled}) {
        SCOPED_TRACE(static_cast<int>(hair));
        const Scene scene = sceneFor(settings, hair, false, 0);
        const Bodies bodies(scene, settings), bending(scene, bent);
        const auto end = [&](std::size_t s, const Strand& before) {
            return backwardEuler(bodies, bending, s, before);
        };
        hold(scene, end, positionsOf, 0.0);
    }
}
INSTANTIATE_TEST_SUITE_P(Systems, ReferenceBackwardEuler, testing::ValuesIn(kBackward),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// Where a substep ends.
struct Ended {
    Positions positions, moved;
};
/// Displacements that forces add at positions, for displacements that stand for velocity.
using Kick = std::function<Positions(const Positions& positions, const Positions& moved)>;

// Equations 7 to 12 of Rünz 2012 and the classical Runge-Kutta method, for displacements u = v h and a h².
Ended explicitEuler(const Kick& kick, const Positions& x, const Positions& u) {
    return {sumOf(x, u), sumOf(u, kick(x, u))};
}
Ended leapfrog(const Kick& kick, const Positions& x, const Positions& u) {
    const Positions half = sumOf(x, u, 0.5), after = sumOf(u, kick(half, u));
    return {sumOf(half, after, 0.5), after};
}
Ended velocityVerlet(const Kick& kick, const Positions& x, const Positions& u) {
    const Positions half = sumOf(u, kick(x, u), 0.5), end = sumOf(x, half);
    const Positions predicted = sumOf(sumOf(half, half), u, -1.0);
    return {end, sumOf(half, kick(end, predicted), 0.5)};
}
Ended rungeKutta(const Kick& kick, const Positions& x, const Positions& u) {
    const Positions a1 = kick(x, u), u2 = sumOf(u, a1, 0.5);
    const Positions a2 = kick(sumOf(x, u, 0.5), u2), u3 = sumOf(u, a2, 0.5);
    const Positions a3 = kick(sumOf(x, u2, 0.5), u3), u4 = sumOf(u, a3);
    const Positions a4 = kick(sumOf(x, u3), u4);
    const auto mean = [](const Positions& k1, const Positions& k2, const Positions& k3, const Positions& k4) {
        Positions sum = k1;
        for (std::size_t p = 0; p < sum.size(); ++p) sum[p] = (k1[p] + 2.0 * (k2[p] + k3[p]) + k4[p]) / 6.0;
        return sum;
    };
    return {sumOf(x, mean(u, u2, u3, u4)), sumOf(u, mean(a1, a2, a3, a4))};
}

struct Rule {
    const char* name;
    runtime::Integrator integrator;
    Ended (*step)(const Kick& kick, const Positions& x, const Positions& u);
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
        const auto kick = [&](const Positions& positions, const Positions& moved) {
            Positions added = bodies.added(s, positions, moved, physics);
            for (std::size_t p = 0; p < settings.clampedPoints; ++p) added[p].setZero();
            return added;
        };
        return GetParam().step(kick, before.positions, before.moved);
    };
    const auto positions = [&](std::size_t s, const Strand& before) { return ended(s, before).positions; };
    const auto moved = [&](std::size_t s, const Strand& before) { return ended(s, before).moved; };
    hold(scene, positions, positionsOf, 1e-5);
    hold(scene, moved, movesOf, 1e-4);
}
INSTANTIATE_TEST_SUITE_P(Rules, ReferenceIntegrators, testing::ValuesIn(kRules),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace hairloom::gpu_simulation
