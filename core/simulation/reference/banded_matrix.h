// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Square banded matrix with an LU factorisation by rows and partial pivoting (Golub and Van Loan 2013,
// Algorithm 4.3.2 and the remark on pivoting: the upper band grows by the lower one).

#include <complex>
#include <cstddef>
#include <vector>

namespace hairloom::reference {

/// Of real or complex numbers.
template <class Scalar>
class BandedMatrixOf {
  public:
    /// Zero matrix of size × size; entries exist where |row − column| ≤ band.
    void resize(std::size_t size, std::size_t band);
    void setZero();
    /// |row − column| ≤ band.
    Scalar& at(std::size_t row, std::size_t column) { return entry(row, column); }

    /// Replaces the matrix by its factors; false when it is singular.
    bool factor();
    /// After factor(): replaces the right side, of `size` entries, by the solution.
    void solve(std::vector<Scalar>& rightSide) const;

  private:
    Scalar& entry(std::size_t row, std::size_t column) {
        return entries_[row * width_ + (column + band_ - row)];
    }
    Scalar entry(std::size_t row, std::size_t column) const {
        return entries_[row * width_ + (column + band_ - row)];
    }

    std::size_t size_ = 0;
    std::size_t band_ = 0;
    std::size_t width_ = 0;
    std::vector<Scalar> entries_;
    std::vector<Scalar> multipliers_;  // size × band, in the order of elimination
    std::vector<std::size_t> pivots_;
};

using BandedMatrix = BandedMatrixOf<double>;
using ComplexBandedMatrix = BandedMatrixOf<std::complex<double>>;

}  // namespace hairloom::reference
