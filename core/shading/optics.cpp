// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/optics.h"

#include <algorithm>
#include <cmath>

namespace hairloom::shading {

BravaisIndices bravaisIndices(double ior, double theta) {
    const double sine = std::sin(theta);
    const double root = std::sqrt(ior * ior - sine * sine);
    const double cosine = std::max(std::cos(theta), 1e-6);
    return {root / cosine, ior * ior * cosine / root};
}

double fresnel(const BravaisIndices& indices, double cosGammaOutside, double cosGammaInside) {
    const double s = indices.perpendicular * cosGammaInside;
    const double p = indices.parallel * cosGammaOutside;
    const double rs = (cosGammaOutside - s) / (cosGammaOutside + s);
    const double rp = (p - cosGammaInside) / (p + cosGammaInside);
    return 0.5 * (rs * rs + rp * rp);
}

CrossSection::CrossSection(double ior, double theta, const Vec3d& absorption)
    : indices_(bravaisIndices(ior, theta)), absorption_(absorption) {
    const double sineInside = std::sin(theta) / ior;
    pathScale_ = 2 / std::sqrt(1 - sineInside * sineInside);
}

CrossSection::Ray CrossSection::at(double h) const {
    const double inside = sineInside(h);
    const double cosOutside = std::sqrt(std::max(0.0, 1 - h * h));
    const double cosInside = std::sqrt(std::max(0.0, 1 - inside * inside));
    const double path = pathScale_ * cosInside;
    Ray ray{fresnel(indices_, cosOutside, cosInside), Vec3d::Ones()};
    for (int c = 0; c < 3; ++c) {
        if (absorption_[c] > 0) ray.transmittance[c] = std::exp(-absorption_[c] * path);
    }
    return ray;
}

Vec3d attenuation(const CrossSection::Ray& ray, int p) {
    if (p == 0) return Vec3d::Constant(ray.reflected);
    const double enters = 1 - ray.reflected;
    Vec3d result = enters * enters * ray.transmittance;
    for (int k = 1; k < p; ++k) result = (ray.reflected * result).cwiseProduct(ray.transmittance);
    return result;
}

Vec3d attenuationFrom(const CrossSection::Ray& ray, int p) {
    // A geometric series in F T. At grazing incidence F = 1 without absorption: nothing has entered.
    const Vec3d rest = (Vec3d::Ones() - ray.reflected * ray.transmittance).cwiseMax(1e-12);
    return attenuation(ray, p).cwiseQuotient(rest);
}

}  // namespace hairloom::shading
