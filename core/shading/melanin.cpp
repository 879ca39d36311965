// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/melanin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {

Vec3d absorption(const Melanin& melanin) {
    return melanin.eumelanin * Vec3d(0.419, 0.697, 1.37) + melanin.pheomelanin * Vec3d(0.187, 0.4, 1.05);
}

double absorptionScale(double azimuthalRoughness) {
    const double b = std::clamp(azimuthalRoughness, 0.0, 1.0);
    return 1 / (5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245)))));
}

Vec3d absorptionOfColour(const Vec3d& colour, double azimuthalRoughness) {
    const double scale = absorptionScale(azimuthalRoughness);
    return (scale * colour.cwiseMax(0.001).cwiseMin(1.0).array().log()).square().matrix();
}

Vec3d colourOfAbsorption(const Vec3d& absorption, double azimuthalRoughness) {
    return (-absorption.cwiseMax(0.0).array().sqrt() / absorptionScale(azimuthalRoughness)).exp().matrix();
}

Vec3d kajiyaColour(const Vec3d& absorption, double azimuthalRoughness) {
    return colourOfAbsorption(absorption, azimuthalRoughness).cwiseSqrt();
}

double longitudinalWidth(double roughness) {
    const double b = std::clamp(roughness, 0.0, 1.0);
    // v = (0.726 β + 0.812 β² + 3.7 β²⁰)² is the variance over θ_o; θ_h moves half as far.
    return 0.5 * (0.726 * b + 0.812 * b * b + 3.7 * std::pow(b, 20));
}

double azimuthalWidth(double roughness) {
    const double b = std::clamp(roughness, 0.0, 1.0);
    const double scale =
        std::sqrt(std::numbers::pi / 8) * (0.265 * b + 1.194 * b * b + 5.372 * std::pow(b, 22));
    return scale * std::numbers::pi / std::numbers::sqrt3;
}

double axisRatio(double eccentricity) {
    const double e = std::clamp(eccentricity, 0.0, 0.95);
    return 1 / std::sqrt(1 - e * e);
}

}  // namespace hairloom::shading
