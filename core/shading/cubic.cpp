// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/cubic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {

RealRoots solveCubic(double a, double b, double c) {
    RealRoots roots;
    if (a == 0) {
        if (b != 0) roots = {{-c / b}, 1};
        return roots;
    }
    const double p = b / a;
    const double q = c / a;
    const double discriminant = q * q / 4 + p * p * p / 27;
    if (discriminant > 0) {
        // Cardano; the larger of the two cube roots first, so that nothing cancels.
        const double root = std::sqrt(discriminant);
        const double u = std::cbrt(q > 0 ? -q / 2 - root : -q / 2 + root);
        roots.x[0] = u == 0 ? 0 : u - p / (3 * u);
        roots.count = 1;
        return roots;
    }
    if (p == 0) return {{0}, 1};
    // Viète.
    const double radius = 2 * std::sqrt(-p / 3);
    const double angle = std::acos(std::clamp(3 * q / (p * radius), -1.0, 1.0)) / 3;
    for (int k = 0; k < 3; ++k) {
        roots.x[static_cast<std::size_t>(k)] = radius * std::cos(angle - 2 * std::numbers::pi * k / 3);
    }
    roots.count = 3;
    return roots;
}

CubicDeflection::CubicDeflection(int p, double etaPrime) {
    constexpr double kPi = std::numbers::pi;
    const double c = std::asin(1 / etaPrime);
    a = -8 * p * c / (kPi * kPi * kPi);
    b = 6 * p * c / kPi - 2;
}

double CubicDeflection::turn() const {
    return std::sqrt(-b / (3 * a));
}

}  // namespace hairloom::shading
