// SPDX-License-Identifier: MIT
#pragma once
// 3 × 3 matrices in double precision.

#include <array>
#include <cstddef>

#include "engine/double3.h"
#include "hairloom/math.h"

namespace hairloom::runtime {

inline Double3 wide(Float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline Float3 narrow(Double3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

struct Matrix3 {
    std::array<Double3, 3> rows;

    /// v with the matrix on its left.
    friend Double3 operator*(const Matrix3& m, Double3 v) {
        return {dotOf(m.rows[0], v), dotOf(m.rows[1], v), dotOf(m.rows[2], v)};
    }
    friend Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
        const auto row = [&](Double3 r) { return b.rows[0] * r.x + b.rows[1] * r.y + b.rows[2] * r.z; };
        return {{row(a.rows[0]), row(a.rows[1]), row(a.rows[2])}};
    }
    friend Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
        return {{a.rows[0] + b.rows[0], a.rows[1] + b.rows[1], a.rows[2] + b.rows[2]}};
    }
    friend Matrix3 operator-(const Matrix3& a, const Matrix3& b) {
        return {{a.rows[0] - b.rows[0], a.rows[1] - b.rows[1], a.rows[2] - b.rows[2]}};
    }
};

inline Matrix3 transposed(const Matrix3& m) {
    const auto& [a, b, c] = m.rows;
    return {{Double3{a.x, b.x, c.x}, Double3{a.y, b.y, c.y}, Double3{a.z, b.z, c.z}}};
}

/// The mean of a matrix and its transpose.
inline Matrix3 symmetric(const Matrix3& m) {
    const Matrix3 sum = m + transposed(m);
    return {{sum.rows[0] * 0.5, sum.rows[1] * 0.5, sum.rows[2] * 0.5}};
}

inline Matrix3 diagonal(double value) {
    return {{Double3{value, 0, 0}, Double3{0, value, 0}, Double3{0, 0, value}}};
}

/// v × on its right.
inline Matrix3 crossMatrix(Double3 v) {
    return {{Double3{0, -v.z, v.y}, Double3{v.z, 0, -v.x}, Double3{-v.y, v.x, 0}}};
}

/// across · (1 − d dᵀ) + along · d dᵀ for a unit vector d.
inline Matrix3 aboutAxis(Double3 d, double across, double along) {
    const double differ = along - across;
    return {{Double3{across + differ * d.x * d.x, differ * d.x * d.y, differ * d.x * d.z},
             Double3{differ * d.y * d.x, across + differ * d.y * d.y, differ * d.y * d.z},
             Double3{differ * d.z * d.x, differ * d.z * d.y, across + differ * d.z * d.z}}};
}

/// Of a matrix that has an inverse.
inline Matrix3 inverseOf(const Matrix3& m) {
    const auto& [a, b, c] = m.rows;
    const Double3 bc = crossOf(b, c), ca = crossOf(c, a), ab = crossOf(a, b);
    const double scale = 1.0 / dotOf(a, bc);
    return transposed({{bc * scale, ca * scale, ab * scale}});
}

}  // namespace hairloom::runtime
