// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/longitudinal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kIterations = 12;
// Near grazing a tilted lobe would send light out through the fibre's axis: c grows without need, and stops
// at this.
constexpr double kLargestCorrection = 3;

/// Energy per step of θ_o that light at θ_i of a lobe with d = 1 has, as far as the Gaussian reaches.
struct Band {
    std::size_t first = 0;
    std::vector<double> weights;

    double sum(const std::vector<double>& factors) const {
        double result = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) result += weights[k] * factors[first + k];
        return result;
    }
};

class Steps {
  public:
    // The Gaussian's deviation over θ_o is 2β; the midpoint rule is as good as exact from steps of that size
    // down.
    explicit Steps(double width)
        : width_(width), count_(static_cast<std::size_t>(std::max(64.0, std::ceil(kPi / width)))) {}

    std::size_t count() const { return count_; }
    double theta(std::size_t i) const { return (static_cast<double>(i) + 0.5) * step() - kPi / 2; }
    double step() const { return kPi / static_cast<double>(count_); }

    std::vector<Band> bands(double tilt) const {
        std::vector<Band> result(count_);
        const auto last = static_cast<double>(count_ - 1);
        for (std::size_t i = 0; i < count_; ++i) {
            const double peak = (2 * tilt - theta(i) + kPi / 2) / step();
            const double reach = 12 * width_ / step() + 1;
            result[i].first = static_cast<std::size_t>(std::clamp(peak - reach, 0.0, last));
            const auto end = static_cast<std::size_t>(std::clamp(peak + reach, 0.0, last));
            for (std::size_t j = result[i].first; j <= end; ++j) {
                const double out = theta(j);
                const double ratio = std::cos(out) / std::cos(0.5 * (out - theta(i)));
                const double x = (0.5 * (theta(i) + out) - tilt) / width_;
                result[i].weights.push_back(std::exp(-0.5 * x * x) / (width_ * std::sqrt(2 * kPi)) * ratio *
                                            ratio * step());
            }
        }
        return result;
    }

  private:
    double width_;
    std::size_t count_;
};

}  // namespace

LongitudinalLobe::LongitudinalLobe(double tilt, double width)
    : tilt_(std::clamp(tilt, -kPi / 6, kPi / 6)), width_(std::clamp(width, kPi / 360, kPi / 3)) {
    const Steps steps(width_);
    const std::vector<Band> straight = steps.bands(0);
    out_.assign(steps.count(), std::numbers::sqrt2 / 2);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        in_ = out_;
        for (std::size_t i = 0; i < in_.size(); ++i) out_[i] = std::sqrt(in_[i] / straight[i].sum(in_));
    }
    in_ = out_;
    if (tilt_ == 0) return;
    const std::vector<Band> tilted = steps.bands(tilt_);
    for (std::size_t i = 0; i < in_.size(); ++i) {
        in_[i] *= std::min(1 / std::max(in_[i] * tilted[i].sum(out_), 1e-9), kLargestCorrection);
    }
}

double LongitudinalLobe::interpolate(const std::vector<double>& factors, double theta) {
    const double x = (theta / kPi + 0.5) * static_cast<double>(factors.size()) - 0.5;
    const double inside = std::clamp(x, 0.0, static_cast<double>(factors.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(inside), factors.size() - 2);
    const double t = inside - static_cast<double>(i);
    return (1 - t) * factors[i] + t * factors[i + 1];
}

double LongitudinalLobe::gauss(double thetaHalf) const {
    const double x = (thetaHalf - tilt_) / width_;
    return std::exp(-0.5 * x * x) / (width_ * std::sqrt(2 * kPi));
}

}  // namespace hairloom::shading
