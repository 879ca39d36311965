// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/banded_matrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hairloom::reference {

void BandedMatrix::resize(std::size_t size, std::size_t band) {
    size_ = size;
    band_ = band;
    width_ = 3 * band + 1;
    entries_.assign(size * width_, 0.0);
    multipliers_.assign(size * band, 0.0);
    pivots_.assign(size, 0);
}

void BandedMatrix::setZero() {
    std::fill(entries_.begin(), entries_.end(), 0.0);
}

bool BandedMatrix::factor() {
    for (std::size_t k = 0; k < size_; ++k) {
        const std::size_t lastRow = std::min(size_ - 1, k + band_);
        const std::size_t lastColumn = std::min(size_ - 1, k + 2 * band_);
        std::size_t pivot = k;
        for (std::size_t row = k + 1; row <= lastRow; ++row) {
            if (std::abs(entry(row, k)) > std::abs(entry(pivot, k))) pivot = row;
        }
        pivots_[k] = pivot;
        if (!(std::abs(entry(pivot, k)) > 0.0)) return false;
        if (pivot != k) {
            for (std::size_t column = k; column <= lastColumn; ++column) {
                std::swap(entry(k, column), entry(pivot, column));
            }
        }
        for (std::size_t row = k + 1; row <= lastRow; ++row) {
            const double factor = entry(row, k) / entry(k, k);
            multipliers_[k * band_ + (row - k - 1)] = factor;
            if (factor == 0.0) continue;
            for (std::size_t column = k + 1; column <= lastColumn; ++column) {
                entry(row, column) -= factor * entry(k, column);
            }
        }
    }
    return true;
}

void BandedMatrix::solve(std::vector<double>& rightSide) const {
    assert(rightSide.size() == size_);
    for (std::size_t k = 0; k < size_; ++k) {
        std::swap(rightSide[k], rightSide[pivots_[k]]);
        const std::size_t lastRow = std::min(size_ - 1, k + band_);
        for (std::size_t row = k + 1; row <= lastRow; ++row) {
            rightSide[row] -= multipliers_[k * band_ + (row - k - 1)] * rightSide[k];
        }
    }
    for (std::size_t k = size_; k-- > 0;) {
        const std::size_t lastColumn = std::min(size_ - 1, k + 2 * band_);
        double value = rightSide[k];
        for (std::size_t column = k + 1; column <= lastColumn; ++column) {
            value -= entry(k, column) * rightSide[column];
        }
        rightSide[k] = value / entry(k, k);
    }
}

}  // namespace hairloom::reference
