// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Square banded matrix with an LU factorisation by rows and partial pivoting (Golub and Van Loan 2013,
// Algorithm 4.3.2 and the remark on pivoting: the upper band grows by the lower one).

#include <cstddef>
#include <vector>

namespace hairloom::reference {

class BandedMatrix {
  public:
    /// Zero matrix of size × size; entries exist where |row − column| ≤ band.
    void resize(std::size_t size, std::size_t band);
    void setZero();
    /// |row − column| ≤ band.
    double& at(std::size_t row, std::size_t column) { return entry(row, column); }

    /// Replaces the matrix by its factors; false when it is singular.
    bool factor();
    /// After factor(): replaces the right side, of `size` entries, by the solution.
    void solve(std::vector<double>& rightSide) const;

  private:
    double& entry(std::size_t row, std::size_t column) {
        return entries_[row * width_ + (column + band_ - row)];
    }
    double entry(std::size_t row, std::size_t column) const {
        return entries_[row * width_ + (column + band_ - row)];
    }

    std::size_t size_ = 0;
    std::size_t band_ = 0;
    std::size_t width_ = 0;
    std::vector<double> entries_;
    std::vector<double> multipliers_;  // size × band, in the order of elimination
    std::vector<std::size_t> pivots_;
};

}  // namespace hairloom::reference
