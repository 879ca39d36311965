// SPDX-License-Identifier: MIT
#include "play/head_turn.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/checks.h"

namespace hairloom::runtime {
namespace {

/// Square metres by which a root's own turn counts: little beside where the roots of a head are, 1 cm and
/// more from their middle.
constexpr double kOwnTurn = 1e-6;
constexpr int kMostSweeps = 12;  ///< of a matrix of four rows; it is diagonal after six

using Row = std::array<double, 4>;
using FourRows = std::array<Row, 4>;
using Components = std::array<double, 3>;

Components toComponents(Float3 v) {
    return {double{v.x}, double{v.y}, double{v.z}};
}

/// One rotation of Jacobi's method, which makes values[p][q] zero.
void rotateRows(FourRows& values, FourRows& vectors, std::size_t p, std::size_t q) {
    if (values[p][q] == 0) return;
    const double theta = (values[q][q] - values[p][p]) / (2 * values[p][q]);
    const double t = (theta < 0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1), s = t * c;
    for (std::size_t k = 0; k < 4; ++k) {
        const double a = values[k][p], b = values[k][q];
        values[k][p] = c * a - s * b;
        values[k][q] = s * a + c * b;
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const double a = values[p][k], b = values[q][k];
        values[p][k] = c * a - s * b;
        values[q][k] = s * a + c * b;
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const double a = vectors[k][p], b = vectors[k][q];
        vectors[k][p] = c * a - s * b;
        vectors[k][q] = s * a + c * b;
    }
}

/// The unit vector that belongs to the largest eigenvalue.
Row greatestEigenvector(FourRows values) {
    FourRows vectors{};
    for (std::size_t i = 0; i < 4; ++i) vectors[i][i] = 1;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        for (std::size_t p = 0; p < 3; ++p) {
            for (std::size_t q = p + 1; q < 4; ++q) rotateRows(values, vectors, p, q);
        }
    }
    std::size_t greatest = 0;
    for (std::size_t i = 1; i < 4; ++i) {
        if (values[i][i] > values[greatest][greatest]) greatest = i;
    }
    return {vectors[0][greatest], vectors[1][greatest], vectors[2][greatest], vectors[3][greatest]};
}

}  // namespace

Quat headTurn(std::span<const Float3> rest, std::span<const RootFrame> roots) {
    Components middleBefore{}, middleNow{};
    double count = 0;
    for (std::size_t s = 0; s < roots.size(); ++s) {
        RootFrame root = roots[s];
        if (!usableWithin(root, kFarthest)) continue;
        const Components before = toComponents(rest[s]), now = toComponents(root.position);
        for (std::size_t k = 0; k < 3; ++k) middleBefore[k] += before[k], middleNow[k] += now[k];
        ++count;
    }
    if (count == 0) return {};
    // Sums of products of coordinates, before and now (Horn 1987, Section 4.A).
    std::array<Components, 3> sums{};
    for (std::size_t s = 0; s < roots.size(); ++s) {
        RootFrame root = roots[s];
        if (!usableWithin(root, kFarthest)) continue;
        const Components before = toComponents(rest[s]), now = toComponents(root.position);
        const Components turned[3] = {toComponents(rotate(root.rotation, {1, 0, 0})),
                                      toComponents(rotate(root.rotation, {0, 1, 0})),
                                      toComponents(rotate(root.rotation, {0, 0, 1}))};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j)
                sums[i][j] += (before[i] - middleBefore[i] / count) * (now[j] - middleNow[j] / count) +
                              kOwnTurn * turned[i][j];
        }
    }
    const auto& [x, y, z] = sums;
    const Row q = greatestEigenvector({{{x[0] + y[1] + z[2], y[2] - z[1], z[0] - x[2], x[1] - y[0]},
                                        {y[2] - z[1], x[0] - y[1] - z[2], x[1] + y[0], z[0] + x[2]},
                                        {z[0] - x[2], x[1] + y[0], y[1] - x[0] - z[2], y[2] + z[1]},
                                        {x[1] - y[0], z[0] + x[2], y[2] + z[1], z[2] - x[0] - y[1]}}});
    Quat turn{static_cast<float>(q[1]), static_cast<float>(q[2]), static_cast<float>(q[3]),
              static_cast<float>(q[0])};
    return normalize(turn) ? turn : Quat{};
}

}  // namespace hairloom::runtime
