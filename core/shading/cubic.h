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

}  // namespace hairloom::shading
