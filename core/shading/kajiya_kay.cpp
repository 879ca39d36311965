// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/kajiya_kay.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {

double kajiyaDiffuse(const Vec3d& tangent, const Vec3d& toLight) {
    const double lt = toLight.dot(tangent);
    return std::sqrt(std::max(0.0, 1.0 - lt * lt));
}

double kajiyaSpecular(const Vec3d& tangent, const Vec3d& toLight, const Vec3d& toView, double exponent) {
    const double lt = toLight.dot(tangent);
    const double vt = toView.dot(tangent);
    const double c = kajiyaDiffuse(tangent, toLight) * kajiyaDiffuse(tangent, toView) - lt * vt;
    if (exponent == 0) return c >= 0 ? 1 : 0;
    return std::pow(std::clamp(c, 0.0, 1.0), exponent);
}

double kajiyaReflectance(double exponent) {
    // The integral of sin^n over 0…pi is sqrt(pi) * Gamma((n + 1) / 2) / Gamma(n / 2 + 1).
    const double n = exponent + 2;
    return 2 * std::sqrt(std::numbers::pi) * std::exp(std::lgamma((n + 1) / 2) - std::lgamma(n / 2 + 1));
}

double kajiyaBound(double weights) {
    return 1 / std::max(1.0, weights);
}

double evaluate(const KajiyaKay& model, const Vec3d& tangent, const Vec3d& toLight, const Vec3d& toView) {
    const double incoming = kajiyaDiffuse(tangent, toLight);
    const double diffuse = model.diffuse / kajiyaReflectance(0);
    const double specular = model.specular * kajiyaSpecular(tangent, toLight, toView, model.exponent) /
                            kajiyaReflectance(model.exponent);
    return (diffuse + specular) * incoming / std::numbers::pi;
}

}  // namespace hairloom::shading
