// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/banded_matrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hairloom::reference {
namespace {

double sizeOf(double value) {
    return std::abs(value);
}
double sizeOf(std::complex<double> value) {
    return std::abs(value.real()) + std::abs(value.imag());
}
double product(double a, double b) {
    return a * b;
}
/// Without the tests for infinities that the operator makes.
std::complex<double> product(std::complex<double> a, std::complex<double> b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

template <class Scalar>
void BandedMatrixOf<Scalar>::resize(std::size_t size, std::size_t band) {
    size_ = size;
    band_ = band;
    width_ = 3 * band + 1;
    entries_.assign(size * width_, Scalar{});
    multipliers_.assign(size * band, Scalar{});
    pivots_.assign(size, 0);
}

template <class Scalar>
void BandedMatrixOf<Scalar>::setZero() {
    std::fill(entries_.begin(), entries_.end(), Scalar{});
}

template <class Scalar>
bool BandedMatrixOf<Scalar>::factor() {
    for (std::size_t k = 0; k < size_; ++k) {
        const std::size_t lastRow = std::min(size_ - 1, k + band_);
        const std::size_t lastColumn = std::min(size_ - 1, k + 2 * band_);
        std::size_t pivot = k;
        for (std::size_t row = k + 1; row <= lastRow; ++row) {
            if (sizeOf(entry(row, k)) > sizeOf(entry(pivot, k))) pivot = row;
        }
        pivots_[k] = pivot;
        if (!(sizeOf(entry(pivot, k)) > 0.0)) return false;
        if (pivot != k) {
            for (std::size_t column = k; column <= lastColumn; ++column) {
                std::swap(entry(k, column), entry(pivot, column));
            }
        }
        const Scalar inverse = 1.0 / entry(k, k);
        const std::size_t columns = lastColumn - k;
        const Scalar* const from = &entry(k, k) + 1;
        for (std::size_t row = k + 1; row <= lastRow; ++row) {
            const Scalar factor = product(entry(row, k), inverse);
            multipliers_[k * band_ + (row - k - 1)] = factor;
            if (factor == Scalar{}) continue;
            Scalar* const into = &entry(row, k) + 1;
            for (std::size_t c = 0; c < columns; ++c) into[c] -= product(factor, from[c]);
        }
    }
    return true;
}

template <class Scalar>
void BandedMatrixOf<Scalar>::solve(std::vector<Scalar>& rightSide) const {
    assert(rightSide.size() == size_);
    for (std::size_t k = 0; k < size_; ++k) {
        std::swap(rightSide[k], rightSide[pivots_[k]]);
        const std::size_t lastRow = std::min(size_ - 1, k + band_);
        for (std::size_t row = k + 1; row <= lastRow; ++row) {
            rightSide[row] -= product(multipliers_[k * band_ + (row - k - 1)], rightSide[k]);
        }
    }
    for (std::size_t k = size_; k-- > 0;) {
        const std::size_t lastColumn = std::min(size_ - 1, k + 2 * band_);
        Scalar value = rightSide[k];
        for (std::size_t column = k + 1; column <= lastColumn; ++column) {
            value -= product(entry(k, column), rightSide[column]);
        }
        rightSide[k] = value / entry(k, k);
    }
}

template class BandedMatrixOf<double>;
template class BandedMatrixOf<std::complex<double>>;

}  // namespace hairloom::reference
