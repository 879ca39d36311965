// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the reference: balance, gradients, stiffness; and the solves under them.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/simulation/reference/banded_matrix.h"
#include "core/simulation/reference/forces.h"
#include "core/simulation/reference/lengths.h"
#include "tests/simulation/reference_fixture.h"

namespace hairloom {
namespace {

using namespace test;

std::vector<Vec3d> randomChain(std::mt19937& random, std::size_t points, double step) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Vec3d> x{Vec3d::Zero()};
    while (x.size() < points)
        x.push_back(x.back() +
                    step * Vec3d(1.0 + 0.4 * uniform(random), 0.4 * uniform(random), 0.4 * uniform(random)));
    return x;
}

std::vector<Vec3d> edgesOf(const std::vector<Vec3d>& x) {
    std::vector<Vec3d> edges;
    for (std::size_t j = 0; j + 1 < x.size(); ++j) edges.push_back(x[j + 1] - x[j]);
    return edges;
}

TEST(ReferenceShape, MassesAndStiffnessAreThoseOfAUniformRod) {
    runtime::SimulationSettings s = bareSettings();
    s.clampedPoints = 2;
    s.angularStiffness = 0.5f;
    const std::vector<Vec3d> edges{{0.1, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {0.4, 0, 0}};
    const reference::StrandShape shape = reference::makeShape(edges, {}, s);
    // h = 0.05, 0.1, 0.15, 0.3, 0.2, of mean 0.16
    const double mean = 0.16;
    EXPECT_NEAR(shape.masses[0], 0.05 / mean, 1e-12);
    EXPECT_NEAR(shape.masses[3], 0.3 / mean, 1e-12);
    const double B = 3.89e9 * 80e-6 * 80e-6 / (16.0 * 1300.0);
    EXPECT_EQ(shape.stiffness[0], 0.0);
    EXPECT_NEAR(shape.stiffness[1], B / mean / 0.05, 1e-12);
    EXPECT_NEAR(shape.stiffness[2], B / mean / 0.15, 1e-12);
    EXPECT_NEAR(shape.stiffness[3], B / mean / 0.3, 1e-12);

    s.angularCurve = runtime::Ramp::straight(1.0f, 0.5f);  // s = 0.5 · (1 − ½ · 3/4) at joint 3
    const double authored = 0.5 * (1.0 - 0.5 * 0.75);
    EXPECT_NEAR(reference::makeShape(edges, {}, s).stiffness[3], B * authored / (1.0 - authored) / mean / 0.3,
                1e-12);

    const runtime::Ramp::Key keys[] = {{0, 0.25f}, {0.375f, 1}, {0.875f, 0.5f}, {1, 0}};
    s.angularCurve = runtime::Ramp::of(keys);
    const auto curved = reference::makeShape(edges, {}, s);
    const double shares[] = {0.25 + 0.75 * (0.25 / 0.375), 1.0 - 0.5 * (0.125 / 0.5),
                             1.0 - 0.5 * (0.375 / 0.5)};
    const double spans[] = {0.05, 0.15, 0.3};
    for (std::size_t j = 1; j <= 3; ++j) {
        const double there = 0.5 * shares[j - 1];
        EXPECT_NEAR(curved.stiffness[j], B * there / (1.0 - there) / mean / spans[j - 1], 1e-12) << j;
    }
}

TEST(ReferenceForces, AreReciprocal) {
    std::mt19937 random(7);
    for (const auto method : {runtime::AngularMethod::smallAngle, runtime::AngularMethod::exact,
                              runtime::AngularMethod::flexion}) {
        runtime::SimulationSettings s = bareSettings();
        s.angularStiffness = 0.5f;
        s.angularMethod = method;
        s.bendDampingTime = 0.01f;
        s.lengthMethod = runtime::LengthMethod::springs;
        s.gravity = {0, 0, 0};
        const reference::StrandShape shape =
            reference::makeShape(edgesOf(randomChain(random, 9, 0.02)), {}, s);
        const std::vector<Vec3d> x = randomChain(random, 9, 0.02), v = randomChain(random, 9, 0.5);
        std::vector<Vec3d> force(9, Vec3d::Zero());
        const reference::Environment around{0.0, reference::Quaterniond::Identity(), Vec3d::Zero(), {}};
        reference::addForces(reference::Physics(s), shape, x, v, around, force);
        Vec3d sum = Vec3d::Zero();
        double largest = 0.0;
        for (const Vec3d& f : force) {
            sum += f;
            largest = std::max(largest, f.norm());
        }
        EXPECT_GT(largest, 0.0);
        EXPECT_LT(sum.norm(), 1e-12 * largest);
    }
}

TEST(ReferenceForces, AreTheGradientOfTheirEnergyWhereFramesDoNotCount) {
    // A straight strand has c = 0: no frame enters. Coil and flexion springs have none at any shape.
    std::mt19937 random(3);
    for (const auto method : {runtime::AngularMethod::smallAngle, runtime::AngularMethod::exact,
                              runtime::AngularMethod::flexion}) {
        runtime::SimulationSettings s = bareSettings();
        s.clampedPoints = 2;
        s.angularStiffness = 0.5f;
        s.angularMethod = method;
        s.lengthMethod = runtime::LengthMethod::springs;
        const reference::Physics physics(s);
        const reference::StrandShape shape =
            reference::makeShape(edgesOf(straightStrand(6, 0.12).restPositions_ss), {}, s);
        std::vector<Vec3d> x = randomChain(random, 7, 0.02);
        x[1] = Vec3d(0.02, 0, 0);
        const reference::Environment around{0.0, reference::Quaterniond::Identity(), Vec3d::Zero(), {}};
        std::vector<Vec3d> force(7, Vec3d::Zero());
        reference::addForces(physics, shape, x, std::vector<Vec3d>(7, Vec3d::Zero()), around, force);
        const auto energy = [&] {
            const auto p = reference::potentials(physics, shape, x, around.rotation);
            return p.gravity + p.springs + p.angular;
        };
        for (std::size_t p = 2; p < 7; ++p) {
            for (int c = 0; c < 3; ++c) {
                const double step = 1e-7, was = x[p][c];
                x[p][c] = was + step;
                const double after = energy();
                x[p][c] = was - step;
                const double slope = (after - energy()) / (2.0 * step);
                x[p][c] = was;
                EXPECT_NEAR(force[p][c], -slope, 1e-5 * (1.0 + force[p].norm()));
            }
        }
    }
}

TEST(ReferenceForces, WholeGradientOfACurledStrandIsThatOfItsEnergy) {
    std::mt19937 random(4);
    for (const std::uint32_t clamped : {1u, 2u}) {
        for (const auto method : {runtime::AngularMethod::smallAngle, runtime::AngularMethod::exact}) {
            runtime::SimulationSettings s = bareSettings();
            s.clampedPoints = clamped;
            s.angularStiffness = 0.5f;
            s.angularMethod = method;
            const reference::Physics physics(s, reference::BendingForce::gradient);
            const std::vector<Vec3d> rest = randomChain(random, 8, 0.02);
            const reference::StrandShape shape = reference::makeShape(edgesOf(rest), {}, s);
            std::vector<Vec3d> x = randomChain(random, 8, 0.02);
            if (clamped == 2) x[1] = rest[1];
            const reference::Environment around{0.0, reference::Quaterniond::Identity(), Vec3d::Zero(), {}};
            std::vector<Vec3d> force(8, Vec3d::Zero());
            reference::addForces(physics, shape, x, std::vector<Vec3d>(8, Vec3d::Zero()), around, force);
            for (std::size_t p = clamped; p < 8; ++p) {
                for (int c = 0; c < 3; ++c) {
                    const double step = 1e-7, was = x[p][c];
                    const auto energyAt = [&](double place) {
                        x[p][c] = place;
                        const auto e = reference::potentials(physics, shape, x, around.rotation);
                        x[p][c] = was;
                        return e.gravity + e.angular;
                    };
                    const double slope = (energyAt(was + step) - energyAt(was - step)) / (2.0 * step);
                    EXPECT_NEAR(force[p][c], -slope, 1e-5 * (1.0 + force[p].norm())) << p;
                }
            }
        }
    }
}

TEST(ReferenceForces, RestShapeAnywhereBearsNoForce) {
    std::mt19937 random(11);
    runtime::SimulationSettings s = bareSettings();
    s.angularStiffness = 0.6f;
    s.gravity = {0, 0, 0};
    const std::vector<Vec3d> rest = randomChain(random, 12, 0.02);
    for (const auto method : {runtime::AngularMethod::smallAngle, runtime::AngularMethod::exact,
                              runtime::AngularMethod::flexion}) {
        s.angularMethod = method;
        const reference::StrandShape shape = reference::makeShape(edgesOf(rest), {}, s);
        const reference::Quaterniond turn(Eigen::AngleAxisd(2.0, Vec3d(1.0, 2.0, -0.5).normalized()));
        std::vector<Vec3d> x;
        for (const Vec3d& p : rest) x.push_back(Vec3d(0.3, 1.7, 0.2) + turn * p);
        std::vector<Vec3d> force(x.size(), Vec3d::Zero());
        const reference::Environment around{0.0, turn, Vec3d::Zero(), {}};
        reference::addForces(reference::Physics(s), shape, x, std::vector<Vec3d>(x.size(), Vec3d::Zero()),
                             around, force);
        for (const Vec3d& f : force) EXPECT_LT(f.norm(), 1e-8);
    }
}

TEST(ReferenceBandedMatrix, SolvesAsADenseSolverDoes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    constexpr int kSize = 40, kBand = 6;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
    reference::BandedMatrix banded;
    banded.resize(kSize, kBand);
    for (int r = 0; r < kSize; ++r) {
        for (int c = std::max(0, r - kBand); c <= std::min(kSize - 1, r + kBand); ++c) {
            if (r == c && r % 4 == 0) continue;  // needs pivoting
            dense(r, c) = uniform(random);
            banded.at(static_cast<std::size_t>(r), static_cast<std::size_t>(c)) = dense(r, c);
        }
    }
    Eigen::VectorXd right(kSize);
    for (int r = 0; r < kSize; ++r) right[r] = uniform(random);
    std::vector<double> solved(right.data(), right.data() + kSize);
    ASSERT_TRUE(banded.factor());
    banded.solve(solved);
    const Eigen::VectorXd product = dense * Eigen::Map<Eigen::VectorXd>(solved.data(), kSize);
    EXPECT_LT((product - right).norm(), 1e-11);
    banded.setZero();
    EXPECT_FALSE(banded.factor());
}

TEST(ReferenceLengths, ProjectionsReachTheConstraintAlongItsGradients) {
    std::mt19937 random(9);
    const runtime::SimulationSettings s = bareSettings();
    const reference::StrandShape shape =
        reference::makeShape(edgesOf(straightStrand(10, 0.2).restPositions_ss), {}, s);
    std::vector<Vec3d> x = randomChain(random, 11, 0.02), v = randomChain(random, 11, 1.0);
    EXPECT_TRUE(reference::projectLengths(shape, x));
    EXPECT_LT(reference::largestStretch(shape, x), 1e-12);
    const std::vector<Vec3d> before = v;
    reference::projectVelocities(shape, x, v);
    // What is taken is orthogonal, in the measure of the masses, to what is left.
    double product = 0.0;
    for (std::size_t p = 0; p < 10; ++p) EXPECT_NEAR((x[p + 1] - x[p]).dot(v[p + 1] - v[p]), 0.0, 1e-14);
    for (std::size_t p = 1; p < 11; ++p) product += shape.masses[p] * v[p].dot(before[p] - v[p]);
    EXPECT_EQ(v[0], before[0]);
    EXPECT_NEAR(product, 0.0, 1e-12);  // v[0] is zero
}

}  // namespace
}  // namespace hairloom
