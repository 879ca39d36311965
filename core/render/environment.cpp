// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/environment.h"

#include <algorithm>
#include <cmath>

#include "core/render/bright_parts.h"

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

// Harmonics hold what is no brighter than so many times the mean.
constexpr double kBrightness = 4;
constexpr std::size_t kMaxParts = 64;
constexpr double kPointlike = 0.03;  // radians

double solidAngle(const LinearImage& image, std::uint32_t y) {
    const double pi = static_cast<double>(kPi);
    return 2 * pi / image.width * (std::cos(pi * y / image.height) - std::cos(pi * (y + 1) / image.height));
}

/// visit(x, y, direction, irradiance) for each pixel. Errors: values that are not finite.
template <class Visit>
Status forPixels(const LinearImage& image, const Visit& visit) {
    const double pi = static_cast<double>(kPi);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        const double theta = pi * (y + 0.5) / image.height;
        const double solid = solidAngle(image, y);
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const float* const rgba = &image.rgba[4 * (std::size_t{y} * image.width + x)];
            const Vec3d radiance = Vec3f(rgba[0], rgba[1], rgba[2]).cast<double>();
            if (!radiance.allFinite()) return fail("an environment image with a value that is not finite");
            const double phi = 2 * pi * ((x + 0.5) / image.width - 0.5);
            visit(x, y,
                  Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)),
                  Vec3d(radiance * solid));
        }
    }
    return {};
}

/// Bright pixels of large images, several to a cell: a third of a degree is more than lights need.
class BrightCells {
  public:
    explicit BrightCells(const LinearImage& image)
        : step_((image.width + kMaxCells - 1) / kMaxCells),
          width_((image.width + step_ - 1) / step_),
          cells_(std::size_t{width_} * ((image.height + step_ - 1) / step_)) {}

    void add(std::uint32_t x, std::uint32_t y, const Vec3d& direction, const Vec3d& irradiance) {
        BrightPixel& cell = cells_[std::size_t{y / step_} * width_ + x / step_];
        cell.x = x / step_;
        cell.y = y / step_;
        cell.toLight_ws += irradiance.sum() * direction;
        cell.irradiance += irradiance;
    }
    std::vector<BrightPixel> take() {
        std::erase_if(cells_, [](const BrightPixel& cell) { return !(cell.irradiance.sum() > 0); });
        for (BrightPixel& cell : cells_) cell.toLight_ws.normalize();
        return std::move(cells_);
    }

  private:
    static constexpr std::uint32_t kMaxCells = 1024;
    std::uint32_t step_, width_;
    std::vector<BrightPixel> cells_;
};

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
    double light = 0;
    auto status = forPixels(image, [&](auto, auto, const Vec3d&, const Vec3d& irradiance) {
        light += std::max(irradiance.sum(), 0.0);
    });
    if (!status) return tl::unexpected(status.error());
    const double threshold = kBrightness * light / (4 * static_cast<double>(kPi));
    std::array<Vec3d, 9> sums;
    sums.fill(Vec3d::Zero());
    BrightCells cells(image);
    status = forPixels(
        image, [&](std::uint32_t x, std::uint32_t y, const Vec3d& direction, const Vec3d& irradiance) {
            if (irradiance.sum() > threshold * solidAngle(image, y)) {
                cells.add(x, y, direction, irradiance);
                return;
            }
            const auto basis = harmonics(direction);
            for (std::size_t i = 0; i < 9; ++i) sums[i] += irradiance * basis[i];
        });
    if (!status) return tl::unexpected(status.error());
    std::vector<BrightPixel> bright = cells.take();
    Environment result;
    for (std::size_t i = 0; i < 9; ++i) result.coefficients[i] = scale * sums[i].cast<float>();
    if (bright.empty() || !(scale > 0)) return result;
    result.brightRoots.push_back(cutBrightPixels(std::move(bright), kMaxParts, kPointlike, result.bright));
    for (BrightPart& part : result.bright) part.irradiance *= scale;
    return result;
}

void Environment::add(const Environment& other) {
    for (std::size_t i = 0; i < 9; ++i) coefficients[i] += other.coefficients[i];
    const int before = static_cast<int>(bright.size());
    for (BrightPart part : other.bright) {
        if (part.first >= 0) part.first += before;
        if (part.second >= 0) part.second += before;
        bright.push_back(part);
    }
    for (const int root : other.brightRoots) brightRoots.push_back(root + before);
}

void Environment::add(const Vec3f& toLight_ws, const Vec3f& irradiance) {
    const auto basis = harmonics(toLight_ws.cast<double>().normalized());
    for (std::size_t i = 0; i < 9; ++i) coefficients[i] += irradiance * static_cast<float>(basis[i]);
}

bool Environment::dark() const {
    return brightRoots.empty() &&
           std::ranges::all_of(coefficients, [](const Vec3f& c) { return c.isZero(0); });
}

Vec3f Environment::radiance(const Vec3f& direction) const {
    const auto basis = harmonics(direction.cast<double>().normalized());
    Vec3f sum = Vec3f::Zero();
    for (std::size_t i = 0; i < 9; ++i) sum += coefficients[i] * static_cast<float>(basis[i]);
    return sum;
}

}  // namespace hairloom::render
