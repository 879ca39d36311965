// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/collocation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace hairloom::reference {
namespace {

/// At `places[i]`, of the polynomial that is 1 at `places[j]` and 0 at the others and at 0.
double slope(const std::vector<double>& places, std::size_t i, std::size_t j) {
    std::vector<double> others{0.0};
    for (std::size_t k = 0; k < places.size(); ++k)
        if (k != j) others.push_back(places[k]);
    double sum = 0.0;
    for (std::size_t left = 0; left < others.size(); ++left) {
        double term = 1.0 / (places[j] - others[left]);
        for (std::size_t k = 0; k < others.size(); ++k)
            if (k != left) term *= (places[i] - others[k]) / (places[j] - others[k]);
        sum += term;
    }
    return sum;
}

Collocation make(std::vector<double> places) {
    Collocation result;
    result.places = std::move(places);
    const auto size = static_cast<Eigen::Index>(result.places.size());
    result.rates.resize(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
        for (Eigen::Index j = 0; j < size; ++j)
            result.rates(i, j) =
                slope(result.places, static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(result.rates);
    result.values = solver.eigenvalues();
    result.vectors = solver.eigenvectors();
    result.inverseVectors = result.vectors.inverse();
    return result;
}

}  // namespace

const Collocation& Collocation::radau(std::size_t stages) {
    assert(stages >= 1 && stages <= 3);
    static const double root = std::sqrt(6.0);
    static const std::array<Collocation, 3> kAll{make({1.0}), make({1.0 / 3.0, 1.0}),
                                                 make({0.1 * (4.0 - root), 0.1 * (4.0 + root), 1.0})};
    return kAll[stages - 1];
}

}  // namespace hairloom::reference
