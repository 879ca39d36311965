// SPDX-License-Identifier: GPL-3.0-or-later
// The factors by which lanes solve their springs, used as the kernel uses them, beside a dense solution.
#include "core/gpu_simulation/models/bend_reduction.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace hairloom::gpu_simulation {
namespace {

/// LDLᵀ of a symmetric pentadiagonal matrix.
struct Factored {
    std::vector<double> inverseDiagonal, lower1, lower2;

    explicit Factored(const Eigen::MatrixXd& matrix) {
        const Eigen::Index n = matrix.rows();
        inverseDiagonal.assign(static_cast<std::size_t>(n), 1.0);
        lower1 = lower2 = std::vector<double>(static_cast<std::size_t>(n), 0.0);
        const Eigen::MatrixXd l = matrix.llt().matrixL();
        for (Eigen::Index p = 0; p < n; ++p) {
            const auto row = static_cast<std::size_t>(p);
            inverseDiagonal[row] = 1.0 / (l(p, p) * l(p, p));
            if (p > 0) lower1[row] = l(p, p - 1) / l(p - 1, p - 1);
            if (p > 1) lower2[row] = l(p, p - 2) / l(p - 2, p - 2);
        }
    }
    BendFactors between(std::uint32_t first, std::uint32_t end) const {
        return {first, end, inverseDiagonal, lower1, lower2};
    }
};

/// 1 + stiffness · (the second differences)ᵀ(second differences), rows outside [first, end) of the unit
/// matrix.
Eigen::MatrixXd beam(Eigen::Index points, Eigen::Index first, Eigen::Index end, double stiffness) {
    std::minstd_rand engine(3);
    std::uniform_real_distribution<double> about(0.7, 1.3);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(points, points);
    for (Eigen::Index j = first; j + 2 <= end; ++j) {
        Eigen::VectorXd bend = Eigen::VectorXd::Zero(points);
        if (j - 1 >= first) bend[j - 1] = about(engine);
        bend[j] = -2.0 * about(engine);
        if (j + 1 < end) bend[j + 1] = about(engine);
        matrix += stiffness * bend * bend.transpose();
    }
    return matrix;
}

/// solveBend() of the kernel, in its precision.
Eigen::VectorXf solvedByLanes(const std::vector<shaders::float4>& quads, Eigen::VectorXf side) {
    const auto points = static_cast<std::uint32_t>(side.size()), steps = reductionSteps(points);
    for (std::uint32_t step = 0; step < steps; ++step) {
        const Eigen::VectorXf exchanged = side;
        const std::uint32_t apart = 2u << step;
        for (std::uint32_t p = 0; p < points; ++p) {
            const std::uint32_t pair = p & ~1u, last = points - 1;
            const std::uint32_t before = pair >= apart ? pair - apart : pair;
            const std::uint32_t after = pair + apart <= last ? pair + apart : pair;
            const shaders::float4 by = quads[p * (steps + 1) + step];
            side[p] += exchanged[before] * by.x + exchanged[std::min(before + 1, last)] * by.y +
                       exchanged[after] * by.z + exchanged[std::min(after + 1, last)] * by.w;
        }
    }
    const Eigen::VectorXf exchanged = side;
    for (std::uint32_t p = 0; p < points; ++p) {
        const shaders::float4 by = quads[p * (steps + 1) + steps];
        side[p] = exchanged[p] * by.x + exchanged[std::min(p ^ 1u, points - 1)] * by.y;
    }
    return side;
}

/// Substitution with the factors, root to tip and back, in the precision of Number.
template <class Number>
std::vector<Number> substituted(const Factored& f, const Eigen::VectorXf& side, std::uint32_t first) {
    const auto points = static_cast<std::uint32_t>(side.size());
    std::vector<Number> x(points, Number(0));
    for (std::uint32_t p = first; p < points; ++p) {
        x[p] = static_cast<Number>(side[p]);
        if (p > first) x[p] -= static_cast<Number>(f.lower1[p]) * x[p - 1];
        if (p > first + 1) x[p] -= static_cast<Number>(f.lower2[p]) * x[p - 2];
    }
    for (std::uint32_t p = points; p-- > first;) {
        x[p] *= static_cast<Number>(f.inverseDiagonal[p]);
        if (p + 1 < points) x[p] -= static_cast<Number>(f.lower1[p + 1]) * x[p + 1];
        if (p + 2 < points) x[p] -= static_cast<Number>(f.lower2[p + 2]) * x[p + 2];
    }
    return x;
}

/// Where springs of any stiffness stand beside each other, single precision loses digits in whatever order it
/// solves.
TEST(BendReduction, LosesNoMoreThanSubstitution) {
    constexpr std::uint32_t kPoints = 16, kFirst = 2;
    for (const double span : {1.0, 3.0, 5.0}) {
        std::minstd_rand engine(5);
        std::uniform_real_distribution<double> about(-1.0, 1.0);
        double byLanes = 0.0, bySubstitution = 0.0;
        for (int strand = 0; strand < 200; ++strand) {
            Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(kPoints, kPoints);
            Eigen::VectorXd pull = Eigen::VectorXd::Zero(kPoints);
            for (Eigen::Index j = 1; j + 1 < kPoints; ++j) {
                Eigen::VectorXd joint = Eigen::VectorXd::Zero(kPoints);
                joint.segment<3>(j - 1) =
                    Eigen::Vector3d(1.0 + 0.5 * about(engine), -2.0, 1.0 + 0.5 * about(engine));
                joint.head(kFirst).setZero();
                const double stiffness = std::pow(10.0, span * about(engine));
                matrix += stiffness * joint * joint.transpose();
                pull += stiffness * about(engine) * joint;
            }
            Factored factored(matrix);
            for (auto* const factors : {&factored.inverseDiagonal, &factored.lower1, &factored.lower2}) {
                for (double& factor : *factors) factor = static_cast<double>(static_cast<float>(factor));
            }
            const Eigen::VectorXf side = pull.cast<float>();
            const auto groundTruth = substituted<double>(factored, side, kFirst);
            const auto found = solvedByLanes(reduce(factored.between(kFirst, kPoints), kPoints), side);
            const auto other = substituted<float>(factored, side, kFirst);
            for (std::uint32_t p = kFirst; p < kPoints; ++p) {
                byLanes += std::abs(static_cast<double>(found[p]) - groundTruth[p]);
                bySubstitution += std::abs(static_cast<double>(other[p]) - groundTruth[p]);
            }
        }
        EXPECT_GT(bySubstitution, 0.0);
        EXPECT_LE(byLanes, 5.0 * bySubstitution) << "stiffness over " << 2.0 * span << " powers of ten";
    }
}

TEST(BendReduction, SolvesAsADenseMatrixDoes) {
    std::minstd_rand engine(11);
    std::uniform_real_distribution<float> about(-1.0f, 1.0f);
    for (const std::uint32_t points : {4u, 5u, 8u, 13u, 16u, 31u, 64u}) {
        for (const std::uint32_t first : {1u, 2u}) {
            for (const std::uint32_t end : {points, points - 1}) {
                for (const double stiffness : {0.03, 8.0, 1e3}) {
                    const Eigen::MatrixXd matrix = beam(points, first, end, stiffness);
                    const Factored factored(matrix);
                    Eigen::VectorXf side = Eigen::VectorXf::Zero(points);
                    for (std::uint32_t p = first; p < end; ++p) side[p] = about(engine);
                    const Eigen::VectorXd groundTruth = matrix.ldlt().solve(side.cast<double>());
                    const Eigen::VectorXf found =
                        solvedByLanes(reduce(factored.between(first, end), points), side);
                    // Elimination of a positive definite matrix loses no more than its condition.
                    const double loss = 1e-6 * (1.0 + 0.02 * stiffness * points);
                    EXPECT_LE((found.cast<double>() - groundTruth).norm(), loss * side.norm())
                        << points << " points from " << first << " to " << end << ", " << stiffness;
                }
            }
        }
    }
}

}  // namespace
}  // namespace hairloom::gpu_simulation
