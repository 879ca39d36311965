// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/reference/lengths.h"

#include <algorithm>
#include <cmath>

namespace hairloom::reference {
namespace {

/// Solves G M⁻¹ Gᵀ λ = value (tridiagonal) with the gradients at x, then adds −M⁻¹ Gᵀ λ to `moved`.
void project(const StrandShape& shape, const std::vector<Vec3d>& x, const std::vector<double>& value,
             std::vector<Vec3d>& moved) {
    const std::size_t first = shape.firstFree - 1, n = shape.segments();
    const auto inverseMass = [&](std::size_t p) { return p < shape.firstFree ? 0.0 : 1.0 / shape.masses[p]; };
    const auto gradient = [&](std::size_t s) -> Vec3d { return (x[s + 1] - x[s]) / shape.lengths[s]; };
    std::vector<double> upper(n, 0.0), lambda(n, 0.0);
    for (std::size_t s = first; s < n; ++s) {
        const Vec3d u = gradient(s);
        const double lower = s == first ? 0.0 : -u.dot(gradient(s - 1)) * inverseMass(s);
        double diagonal = u.squaredNorm() * (inverseMass(s) + inverseMass(s + 1));
        double right = value[s];
        if (s > first) {
            diagonal -= lower * upper[s - 1];
            right -= lower * lambda[s - 1];
        }
        if (s + 1 < n) upper[s] = -u.dot(gradient(s + 1)) * inverseMass(s + 1) / diagonal;
        lambda[s] = right / diagonal;
    }
    for (std::size_t s = n - 1; s-- > first;) lambda[s] -= upper[s] * lambda[s + 1];
    std::vector<Vec3d> correction(n + 1, Vec3d::Zero());
    for (std::size_t s = first; s < n; ++s) {
        const Vec3d push = gradient(s) * lambda[s];
        correction[s] += push * inverseMass(s);
        correction[s + 1] -= push * inverseMass(s + 1);
    }
    for (std::size_t p = shape.firstFree; p <= n; ++p) moved[p] += correction[p];
}

}  // namespace

double largestStretch(const StrandShape& shape, const std::vector<Vec3d>& x) {
    double largest = 0.0;
    for (std::size_t s = shape.firstFree - 1; s < shape.segments(); ++s)
        largest = std::max(largest, std::abs((x[s + 1] - x[s]).norm() / shape.lengths[s] - 1.0));
    return largest;
}

bool projectLengths(const StrandShape& shape, std::vector<Vec3d>& x) {
    std::vector<double> error(shape.segments(), 0.0);
    for (int iteration = 0; iteration < 50; ++iteration) {
        if (largestStretch(shape, x) < 2e-13) return true;
        for (std::size_t s = shape.firstFree - 1; s < shape.segments(); ++s)
            error[s] = 0.5 * ((x[s + 1] - x[s]).squaredNorm() / shape.lengths[s] - shape.lengths[s]);
        project(shape, x, error, x);
    }
    return largestStretch(shape, x) < 1e-12;
}

void projectVelocities(const StrandShape& shape, const std::vector<Vec3d>& x, std::vector<Vec3d>& v) {
    std::vector<double> rate(shape.segments(), 0.0);
    for (std::size_t s = shape.firstFree - 1; s < shape.segments(); ++s)
        rate[s] = (x[s + 1] - x[s]).dot(v[s + 1] - v[s]) / shape.lengths[s];
    project(shape, x, rate, v);
}

}  // namespace hairloom::reference
