// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/alternatives/hair_flow.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/runtime/hair_block.h"
#include "tests/runtime/strand_fixture.h"
#include "tests/runtime/threads.h"

namespace hairloom::runtime {
namespace {

using Eigen::Index;

constexpr float kFrame = 1.0f / 60.0f;

HairFlow makeFlow(const HairBlock& hair, const HairFlowSettings& settings, Host host = {}) {
    HairFlow::Result made = HairFlow::make(hair.view(), settings, std::move(host));
    EXPECT_EQ(made.error, "");
    return std::move(*made.flow);
}

HairFlowSettings cells(float size, float friction, float spreading) {
    HairFlowSettings s;
    s.cellSize = size;
    s.friction = friction;
    s.spreading = spreading;
    return s;
}

/// Masses and velocities of the faces of a grid, summed point by point with the weights of a product of hat
/// functions about each face.
struct Faces {
    Eigen::VectorXd mass[3], velocity[3], centre;

    Faces(const HairFlow& flow, std::span<const Float3> positions, std::span<const Float3> velocities,
          double cell) {
        const auto& size = flow.size();
        const auto count = static_cast<Index>(std::size_t{size[0]} * size[1] * size[2]);
        centre = Eigen::VectorXd::Zero(count);
        for (std::size_t axis = 0; axis < 3; ++axis)
            mass[axis] = velocity[axis] = Eigen::VectorXd::Zero(count);
        const auto hat = [](double x) { return std::max(1.0 - std::abs(x), 0.0); };
        for (Index f = 0; f < count; ++f) {
            const Index nx = size[0], ny = size[1];
            const double at[3] = {static_cast<double>(f % nx + flow.origin()[0]),
                                  static_cast<double>(f / nx % ny + flow.origin()[1]),
                                  static_cast<double>(f / nx / ny + flow.origin()[2])};
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const double p[3] = {static_cast<double>(positions[i].x) / cell,
                                     static_cast<double>(positions[i].y) / cell,
                                     static_cast<double>(positions[i].z) / cell};
                const double v[3] = {static_cast<double>(velocities[i].x),
                                     static_cast<double>(velocities[i].y),
                                     static_cast<double>(velocities[i].z)};
                const double m = static_cast<double>(flow.masses()[i]);
                double middle = m;
                for (std::size_t k = 0; k < 3; ++k) middle *= hat(p[k] - at[k] - 0.5);
                centre(f) += middle;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    double weight = m;
                    for (std::size_t k = 0; k < 3; ++k) weight *= hat(p[k] - at[k] - (k == axis ? 0.0 : 0.5));
                    mass[axis](f) += weight;
                    velocity[axis](f) += weight * v[axis];
                }
            }
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (mass[axis](f) > 0.0) velocity[axis](f) /= mass[axis](f);
            }
        }
    }
};

/// 1/s, of the velocities that the flow has on its faces.
double divergenceOf(const HairFlow& flow, std::size_t cell, double size) {
    const std::size_t stride[3] = {1, flow.size()[0], std::size_t{flow.size()[0]} * flow.size()[1]};
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        sum += flow.faceVelocity(axis, cell + stride[axis]) - flow.faceVelocity(axis, cell);
    return sum / size;
}

std::size_t cellCount(const HairFlow& flow) {
    return std::size_t{flow.size()[0]} * flow.size()[1] * flow.size()[2];
}

TEST(HairFlow, FilledCellsHaveNoDivergence) {
    const HairBlock hair = blockOfHair(12, 12, 0.005f);
    HairFlow flow = makeFlow(hair, cells(0.01f, 0, 0));
    const std::vector<Float3> positions = shaken(hair.positions, 0.002f, 1);
    std::vector<Float3> velocities = shaken(std::vector<Float3>(positions.size()), 1.0f, 2);
    const auto report = flow.apply(positions, velocities, kFrame);
    EXPECT_GT(report.cells, 100u);
    EXPECT_GT(report.divergence, 10.0);
    EXPECT_LT(report.left, 1e-5 * report.divergence);
    std::size_t filled = 0;
    for (std::size_t c = 0; c < cellCount(flow); ++c) {
        if (!flow.filled(c)) continue;
        ++filled;
        EXPECT_NEAR(divergenceOf(flow, c, 0.01), 0.0, 1e-5 * report.divergence) << c;
    }
    EXPECT_EQ(filled, report.cells);
}

/// The projection is the velocity without divergence that is nearest by kinetic energy: the least ½ (u − u₀)ᵀ
/// M (u − u₀) with B u = 0, here by its dense equations of Lagrange.
TEST(HairFlow, TheSolveIsTheNearestFlowWithoutDivergence) {
    const HairBlock hair = blockOfHair(5, 5, 0.008f);
    HairFlow flow = makeFlow(hair, cells(0.016f, 0, 0));
    const std::vector<Float3> positions = shaken(hair.positions, 0.002f, 6);
    std::vector<Float3> velocities = shaken(std::vector<Float3>(positions.size()), 1.0f, 7);
    const std::vector<Float3> before = velocities;
    flow.apply(positions, velocities, kFrame);
    const double cell = static_cast<double>(0.016f);
    const Faces faces(flow, positions, before, cell);
    const auto count = static_cast<Index>(cellCount(flow));
    const Index stride[3] = {1, flow.size()[0], static_cast<Index>(flow.size()[0]) * flow.size()[1]};
    std::vector<Index> filled;
    for (Index c = 0; c < count; ++c) {
        if (flow.filled(static_cast<std::size_t>(c))) filled.push_back(c);
    }
    ASSERT_GT(filled.size(), 8u);
    const auto rows = static_cast<Index>(filled.size());
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(rows, 3 * count);
    for (Index r = 0; r < rows; ++r) {
        for (Index axis = 0; axis < 3; ++axis) {
            const Index c = filled[static_cast<std::size_t>(r)];
            b(r, axis * count + c) = -1.0;
            b(r, axis * count + c + stride[axis]) = 1.0;
        }
    }
    Eigen::VectorXd inverse(3 * count), start(3 * count);
    for (Index axis = 0; axis < 3; ++axis) {
        for (Index c = 0; c < count; ++c) {
            // A face that has next to no hair counts as 10⁻⁴ of its denser cell.
            const double beside = c >= stride[axis] ? faces.centre(c - stride[axis]) : 0.0;
            const double least = 1e-4 * std::max(beside, faces.centre(c));
            const double mass = std::max(faces.mass[axis](c), least);
            inverse(axis * count + c) = mass > 0.0 ? 1.0 / mass : 0.0;
            start(axis * count + c) = faces.velocity[axis](c);
        }
    }
    const Eigen::VectorXd multipliers = (b * inverse.asDiagonal() * b.transpose()).ldlt().solve(b * start);
    const Eigen::VectorXd nearest = start - inverse.asDiagonal() * b.transpose() * multipliers;
    for (Index axis = 0; axis < 3; ++axis) {
        for (Index c = 0; c < count; ++c) {
            // Faces without hair move nothing.
            if (faces.mass[axis](c) < 1e-9) continue;
            EXPECT_NEAR(flow.faceVelocity(static_cast<std::size_t>(axis), static_cast<std::size_t>(c)),
                        nearest(axis * count + c), 1e-3)
                << axis << " " << c;
        }
    }
}

TEST(HairFlow, TheMomentumStays) {
    const HairBlock hair = blockOfHair(10, 10, 0.005f);
    HairFlow flow = makeFlow(hair, cells(0.011f, 10, 5));
    std::vector<Float3> positions = shaken(hair.positions, 0.003f, 3);
    for (Float3& p : positions) p = p * 0.8f;
    std::vector<Float3> velocities = shaken(std::vector<Float3>(positions.size()), 1.0f, 4);
    for (Float3& v : velocities) v = v + Float3{1, -2, 0.5f};
    const auto before = momentumOf(velocities, flow.masses());
    const std::vector<Float3> first = velocities;
    EXPECT_EQ(flow.apply(positions, velocities, kFrame).leftOut, 0u);
    const auto after = momentumOf(velocities, flow.masses());
    double exchanged = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i)
        exchanged += static_cast<double>(flow.masses()[i] * length(velocities[i] - first[i]));
    EXPECT_GT(exchanged, 0.1);
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(after[axis], before[axis], 1e-3 * exchanged) << axis;
}

/// A rotation has no divergence, and a mean velocity has none: FLIP leaves them. Friction takes what is a
/// strand's own at its rate.
TEST(HairFlow, StrandsKeepTheirOwnMotionAndRubAtTheirRate) {
    const HairBlock hair = blockOfHair(10, 10, 0.005f);
    const Float3 mean{0.3f, 1, -2};
    std::vector<Float3> velocities;
    for (std::size_t i = 0; i < hair.positions.size(); ++i)
        velocities.push_back(mean + Float3{0, 0, i / 10 % 2 == 0 ? 0.1f : -0.1f});
    const std::vector<Float3> before = velocities;
    HairFlow keeps = makeFlow(hair, cells(0.01f, 0, 0));
    keeps.apply(hair.positions, velocities, kFrame);
    const std::size_t middle = hair.middle();
    EXPECT_LT(length(velocities[middle] - before[middle]), 0.02f);
    velocities = before;
    HairFlow rubs = makeFlow(hair, cells(0.01f, 60, 0));
    rubs.apply(hair.positions, velocities, kFrame);
    EXPECT_NEAR((velocities[middle].z - mean.z) / (before[middle].z - mean.z), std::exp(-1.0f), 0.15f);
}

TEST(HairFlow, PressedHairSpreadsAndHairAtRestDoesNot) {
    const HairBlock hair = blockOfHair(12, 12, 0.005f);
    HairFlow flow = makeFlow(hair, cells(0.0f, 0, 5));
    std::vector<Float3> velocities(hair.positions.size());
    EXPECT_NEAR(flow.apply(hair.positions, velocities, kFrame).cellSize, 0.01f, 1e-5f)
        << "chosen from the spacing";
    for (const Float3& v : velocities) EXPECT_LT(length(v), 1e-6f);
    std::vector<Float3> positions = hair.positions;
    for (Float3& p : positions) p = p * 0.75f;  // 2.4 times as dense
    flow.apply(positions, velocities, kFrame);
    EXPECT_GT(velocities[hair.at(11, 6, 6)].x, 0.01f);
    EXPECT_LT(velocities[hair.at(0, 6, 6)].x, -0.01f);
    for (std::size_t c = 0; c < cellCount(flow); ++c) {
        if (flow.filled(c)) {
            EXPECT_GE(divergenceOf(flow, c, 0.01), -1e-4);
        }
    }
}

/// A few strands alone count as more or less dense as they lie to the cells. Nothing may come of that.
TEST(HairFlow, WhereTheCellsAreMovesNothing) {
    const HairBlock hair = blockOfHair(3, 12, 0.005f);
    HairFlow flow = makeFlow(hair, cells(0.015f, 10, 10));
    for (int n = 0; n < 64; ++n) {
        std::vector<Float3> positions = hair.positions, velocities(positions.size());
        const Float3 shift =
            Float3{static_cast<float>(n % 4), static_cast<float>(n / 4 % 4), static_cast<float>(n / 16)} *
            (0.015f / 4);
        for (Float3& p : positions) p = p + shift;
        flow.apply(positions, velocities, kFrame);
        for (const Float3& v : velocities) EXPECT_LT(length(v), 1e-6f) << n;
    }
}

TEST(HairFlow, SameBitsForAnyNumberOfThreads) {
    const HairBlock hair = blockOfHair(12, 12, 0.005f);
    std::vector<std::vector<Float3>> results;
    for (const Host& host : {Host{}, hostWithThreads(1), hostWithThreads(6), hostWithThreads(3, true)}) {
        HairFlow flow = makeFlow(hair, {}, host);
        std::vector<Float3> velocities = shaken(std::vector<Float3>(hair.positions.size()), 1.0f, 8);
        flow.apply(shaken(hair.positions, 0.004f, 2), velocities, kFrame);
        results.push_back(velocities);
    }
    for (const auto& other : results)
        EXPECT_EQ(std::memcmp(other.data(), results[0].data(), other.size() * sizeof(Float3)), 0);
}

TEST(HairFlow, BadInputIsRefusedOrLeftOut) {
    const HairBlock hair = blockOfHair(4, 4, 0.005f);
    const auto error = [&](HairFlowSettings s) { return HairFlow::make(hair.view(), s).error; };
    EXPECT_NE(error(cells(2, 0, 0)).find("cellSize"), std::string::npos);
    EXPECT_NE(error(cells(0, -1, 0)).find("friction"), std::string::npos);
    EXPECT_NE(error(cells(0, 0, std::numeric_limits<float>::quiet_NaN())).find("spreading"),
              std::string::npos);
    HairFlowSettings few;
    few.maxCells = 7;
    few.fill = 3;
    EXPECT_NE(error(few).find("maxCells"), std::string::npos);
    EXPECT_NE(error(few).find("fill"), std::string::npos);
    EXPECT_FALSE(HairFlow::make({}, {}).error.empty());
    HairFlow flow = makeFlow(hair, {});
    std::vector<Float3> positions = hair.positions, velocities(positions.size());
    positions[3].x = std::numeric_limits<float>::quiet_NaN();
    positions[5].y = 1e30f;
    velocities[7].z = std::numeric_limits<float>::infinity();
    positions[9] = {9e5f, 0, 0};
    const auto report = flow.apply(positions, velocities, kFrame);
    EXPECT_EQ(report.leftOut, 3u);
    EXPECT_LE(cellCount(flow), std::size_t{1} << 20);
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        if (i != 7) {
            EXPECT_TRUE(isFinite(velocities[i])) << i;
        }
    }
    const std::vector<Float3> kept = velocities;
    EXPECT_EQ(flow.apply(positions, velocities, 0.0f).cells, 0u);
    EXPECT_EQ(std::memcmp(kept.data(), velocities.data(), kept.size() * sizeof(Float3)), 0);
}

}  // namespace
}  // namespace hairloom::runtime
