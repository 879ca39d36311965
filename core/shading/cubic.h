// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace hairloom::shading {

struct RealRoots {
    std::array<double, 3> x{};
    int count = 0;
};
/// The real roots of a x³ + b x + c, in no order, a double one once or twice; with a = 0 that of the line.
/// Nothing where a = b = 0.
RealRoots solveCubic(double a, double b, double c);

/// How far light that is reflected p − 1 times inside a fibre of the index η' is turned, without the turn by
/// p π, by Marschner's approximation of the angle inside: a γ³ + b γ of the angle of incidence (Eq. 41, 42).
struct CubicDeflection {
    double a, b;
    CubicDeflection(int p, double etaPrime);

    double operator()(double gamma) const { return (a * gamma * gamma + b) * gamma; }
    double slope(double gamma) const { return 3 * a * gamma * gamma + b; }
    /// γ at which it turns back. b > 0: TRT with η' < 2.
    double turn() const;
};

}  // namespace hairloom::shading
