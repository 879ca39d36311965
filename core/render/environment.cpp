// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/environment.h"

#include <algorithm>
#include <cmath>

namespace hairloom::render {
namespace {

std::array<double, 9> harmonics(const Vec3d& d) {
    return {0.28209479177387814,
            0.48860251190291992 * d.y(),
            0.48860251190291992 * d.z(),
            0.48860251190291992 * d.x(),
            1.0925484305920792 * d.x() * d.y(),
            1.0925484305920792 * d.y() * d.z(),
            0.31539156525252005 * (3 * d.z() * d.z() - 1),
            1.0925484305920792 * d.z() * d.x(),
            0.54627421529603959 * (d.x() * d.x() - d.y() * d.y())};
}

}  // namespace

Environment Environment::gradient(const Vec3f& sky, const Vec3f& ground) {
    Environment result;
    result.coefficients[0] = 0.5f * (sky + ground) / 0.28209479f;
    result.coefficients[1] = 0.5f * (sky - ground) / 0.48860251f;
    return result;
}

Result<Environment> Environment::fromImage(const LinearImage& image, float scale) {
    if (image.width == 0 || image.height == 0 ||
        image.rgba.size() != std::size_t{4} * image.width * image.height) {
        return fail("an environment image without pixels");
    }
    std::array<Vec3d, 9> sums;
    sums.fill(Vec3d::Zero());
    const double pi = static_cast<double>(kPi);
    const double pixel = 2 * pi / image.width * pi / image.height;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        const double theta = pi * (y + 0.5) / image.height;
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const float* const rgba = &image.rgba[4 * (std::size_t{y} * image.width + x)];
            const Vec3d light(static_cast<double>(rgba[0]), static_cast<double>(rgba[1]),
                              static_cast<double>(rgba[2]));
            if (!light.allFinite()) return fail("an environment image with a value that is not finite");
            const double phi = 2 * pi * ((x + 0.5) / image.width - 0.5);
            const Vec3d direction(std::sin(theta) * std::sin(phi), std::cos(theta),
                                  std::sin(theta) * std::cos(phi));
            const auto basis = harmonics(direction);
            for (std::size_t i = 0; i < 9; ++i) sums[i] += light * (basis[i] * std::sin(theta) * pixel);
        }
    }
    Environment result;
    for (std::size_t i = 0; i < 9; ++i) result.coefficients[i] = scale * sums[i].cast<float>();
    return result;
}

bool Environment::dark() const {
    return std::ranges::all_of(coefficients, [](const Vec3f& c) { return c.isZero(0); });
}

Vec3f Environment::radiance(const Vec3f& direction) const {
    const auto basis = harmonics(direction.cast<double>().normalized());
    Vec3f sum = Vec3f::Zero();
    for (std::size_t i = 0; i < 9; ++i) sum += coefficients[i] * static_cast<float>(basis[i]);
    return sum;
}

}  // namespace hairloom::render
