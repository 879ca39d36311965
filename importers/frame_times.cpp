// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/frame_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hairloom {
namespace {

constexpr double kSame = 1e-4;  ///< seconds, and a share of a frame: times that are one
constexpr std::size_t kMaxFrames = 100'000;
constexpr double kMaxRate = 1000;  ///< frames a second that uneven samples lead to

/// Whether every sample is that of a frame.
bool fallsOn(std::span<const double> samples, double step) {
    return std::ranges::all_of(samples, [&](double sample) {
        const double frames = (sample - samples.front()) / step;
        return std::abs(frames - std::round(frames)) * step <= std::min(kSame, step * 0.01);
    });
}

/// The longest step that leads from each sample to the next, by Euclid's algorithm; 0 where there is none.
double commonStep(std::span<const double> samples) {
    double step = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        double a = samples[i] - samples[i - 1], b = step;
        while (b > kSame) {
            const double rest = a - b * std::round(a / b);
            a = b;
            b = std::abs(rest);
        }
        step = a;
    }
    if (!(step > 0) || step < 1 / kMaxRate) return 0;
    // Without the rounding of all these differences.
    const double length = samples.back() - samples.front();
    step = length / std::round(length / step);
    return fallsOn(samples, step) ? step : 0;
}

}  // namespace

std::optional<FrameTimes> frameTimes(std::span<const double> samples, double asked, double usual) {
    if (samples.size() < 2) return std::nullopt;
    const double length = samples.back() - samples.front();
    double least = length, most = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        least = std::min(least, samples[i] - samples[i - 1]);
        most = std::max(most, samples[i] - samples[i - 1]);
    }
    if (!(least > 0) || !std::isfinite(length)) return std::nullopt;
    const double even = length / static_cast<double>(samples.size() - 1);
    const bool isEven = most - least <= std::max(1e-6, 0.002 * even);
    double step = even;
    if (asked > 0)
        step = 1 / asked;
    else if (!isEven && usual > 0 && fallsOn(samples, 1 / usual))
        step = 1 / usual;
    else if (!isEven)
        step = commonStep(samples);
    if (step == 0) step = std::max(least, usual > 0 ? 1 / usual : 1 / kMaxRate);
    const double frames = std::floor(length / step + 1e-6) + 1;
    if (!(frames <= static_cast<double>(kMaxFrames))) return std::nullopt;
    FrameTimes times;
    times.rate = 1 / step;
    // A rate that was meant whole, or as film and television have it.
    for (const double nice : {std::round(times.rate), std::round(times.rate * 1.001) / 1.001}) {
        if (std::abs(times.rate - nice) < 1e-4 * times.rate) {
            times.rate = nice;
            break;
        }
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(frames); ++i)
        times.seconds.push_back(samples.front() + static_cast<double>(i) * step);
    if (isEven && std::abs(step - even) <= 1e-6 * even) return times;
    times.said = isEven ? fmt::format("{} samples at {:.6g} a second became {} frames at {:.6g}",
                                      samples.size(), 1 / even, times.seconds.size(), times.rate)
                        : fmt::format(
                              "{} samples are {:.4g} to {:.4g} s apart; they became {} even frames at {:.6g} "
                              "a second",
                              samples.size(), least, most, times.seconds.size(), times.rate);
    return times;
}

}  // namespace hairloom
