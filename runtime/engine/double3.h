// SPDX-License-Identifier: MIT
#pragma once
// Vectors in double precision, for what is prepared before strands move.

namespace hairloom::runtime {

struct Double3 {
    double x = 0.0, y = 0.0, z = 0.0;

    friend Double3 operator+(Double3 a, Double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Double3 operator*(Double3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

inline double dotOf(Double3 a, Double3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Double3 crossOf(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace hairloom::runtime
