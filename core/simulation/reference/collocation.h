// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Radau IIA collocation (Hairer and Wanner 1996, Section IV.5): a step's quantities are polynomials through
// their value at its start and their values in the stages, at which the equations hold; the last stage is
// the end of the step. L-stable for any count of stages.

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace hairloom::reference {

struct Collocation {
    /// `stages` 1 (the implicit Euler method), 2 or 3: of order 2 stages − 1 for equations without
    /// constraints.
    static const Collocation& radau(std::size_t stages);

    std::vector<double> places;  ///< of the stages, shares of the step
    /// Times y_j − y(start), summed over j: h ẏ in stage i.
    Eigen::MatrixXd rates;
    /// rates = vectors · diag(values) · inverseVectors.
    Eigen::VectorXcd values;
    Eigen::MatrixXcd vectors, inverseVectors;

    std::size_t stages() const { return places.size(); }
};

}  // namespace hairloom::reference
