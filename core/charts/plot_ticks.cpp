// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/plot_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hairloom {
namespace {

constexpr double kRounding = 1e-9;
/// Ends of what a logarithmic axis can show.
constexpr double kSmallest = 1e-307, kLargest = 1e307;

/// Powers of ten that read well as plain numbers.
constexpr int kLowestPlain = -2;
constexpr int kHighestPlain = 3;

std::string withMinusSign(std::string text) {
    for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at)) {
        text.replace(at, 1, "\u2212");
    }
    return text;
}

std::string decadeText(int power, bool plain) {
    if (plain) return numberText(std::pow(10.0, power));
    return withMinusSign(fmt::format("10^{}", power));
}

/// As many decimals as the step needs, so that 0.5, 1.0, 1.5 line up.
std::string stepText(double value, double step) {
    const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + kRounding)));
    if (decimals > 6 || std::abs(value) >= 1e7) return numberText(value);
    if (std::abs(value) < step * kRounding) value = 0;
    return withMinusSign(fmt::format("{:.{}f}", value, decimals));
}

void addLinearTicks(AxisLayout& layout, double step) {
    const double first = std::ceil(layout.low / step - kRounding);
    const double last = std::floor(layout.high / step + kRounding);
    for (double k = first; k <= last; ++k) layout.ticks.push_back({k * step, stepText(k * step, step)});
}

/// 1, 2 and 5 of each decade, for ranges too short for decades alone.
void addShortLogarithmicTicks(AxisLayout& layout) {
    const int from = static_cast<int>(std::floor(std::log10(layout.low)));
    const int to = static_cast<int>(std::ceil(std::log10(layout.high)));
    for (int power = from; power <= to; ++power) {
        for (int digit = 1; digit < 10; ++digit) {
            const double value = digit * std::pow(10.0, power);
            if (!layout.within(value)) continue;
            if (digit == 1 || digit == 2 || digit == 5) {
                layout.ticks.push_back({value, numberText(value)});
            } else {
                layout.minorTicks.push_back(value);
            }
        }
    }
}

void addDecades(AxisLayout& layout, int maxTicks) {
    const int from = static_cast<int>(std::ceil(std::log10(layout.low) - kRounding));
    const int to = static_cast<int>(std::floor(std::log10(layout.high) + kRounding));
    const int every = std::max(1, (to - from + maxTicks) / maxTicks);
    const bool plain = from >= kLowestPlain && to <= kHighestPlain;
    for (int power = from - 1; power <= to; ++power) {
        const double decade = std::pow(10.0, power);
        const bool labelled = power >= from && power % every == 0;
        if (labelled) layout.ticks.push_back({decade, decadeText(power, plain)});
        for (int digit = labelled ? 2 : 1; digit < (every > 1 ? 2 : 10); ++digit) {
            if (layout.within(digit * decade)) layout.minorTicks.push_back(digit * decade);
        }
    }
}

struct Range {
    double low, high;
};

Range rangeOf(const Axis& axis, const AxisLayout& layout, const std::vector<double>& values) {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto take = [&](double value) {
        if (!layout.drawable(value)) return;
        range.low = std::min(range.low, value);
        range.high = std::max(range.high, value);
    };
    for (const double value : values) take(value);
    for (const AxisTick& tick : axis.ticks) take(tick.value);
    const bool logarithmic = axis.scale == Scale::Logarithmic;
    if (range.low > range.high) range = {logarithmic ? 1.0 : 0.0, logarithmic ? 10.0 : 1.0};
    return range;
}

/// Room around the values, so that markers stand clear of the frame; never none at all.
Range widened(Range range, Scale scale, bool padded) {
    if (scale == Scale::Logarithmic) {
        const double decades = std::log10(range.high) - std::log10(range.low);
        const double extra = decades > 0 ? (padded ? std::max(0.06 * decades, 0.05) : 0.0) : 0.5;
        return {std::max(range.low * std::pow(10.0, -extra), kSmallest),
                std::min(range.high * std::pow(10.0, extra), kLargest)};
    }
    const double span = range.high - range.low;
    const double extra = span > 0 ? (padded ? 0.05 * span : 0.0) : std::max(0.5 * std::abs(range.low), 0.5);
    return {range.low - extra, range.high + extra};
}

}  // namespace

bool AxisLayout::drawable(double value) const {
    return std::isfinite(value) && (scale == Scale::Linear || value > 0);
}

bool AxisLayout::within(double value) const {
    if (!drawable(value)) return false;
    const double at = share(value);
    return at >= -kRounding && at <= 1 + kRounding;
}

double AxisLayout::share(double value) const {
    if (scale == Scale::Logarithmic) {
        return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
    }
    return (value - low) / (high - low);
}

double niceStep(double step) {
    const double decade = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * decade >= step * (1 - kRounding)) return factor * decade;
    }
    return 10 * decade;
}

std::string numberText(double value) {
    return withMinusSign(fmt::format("{:.10g}", value));
}

AxisLayout layoutAxis(const Axis& axis, const std::vector<double>& values, double length, double spacing,
                      bool padded) {
    AxisLayout layout;
    layout.scale = axis.scale;
    const Range data = rangeOf(axis, layout, values);
    const Range wide = widened(data, axis.scale, padded);
    layout.low = axis.low && layout.drawable(*axis.low) ? *axis.low : wide.low;
    layout.high = axis.high && layout.drawable(*axis.high) ? *axis.high : wide.high;
    // A given end may lie on the wrong side of the data.
    if (!(layout.low < layout.high)) {
        const Range around = widened({layout.low, layout.low}, axis.scale, padded);
        if (axis.low && !axis.high)
            layout.high = around.high;
        else
            layout.low = layout.high - (around.high - around.low);
    }
    if (!axis.ticks.empty()) {
        for (const AxisTick& tick : axis.ticks) {
            if (layout.within(tick.value)) layout.ticks.push_back(tick);
        }
        return layout;
    }
    const int maxTicks = std::max(2, static_cast<int>(length / spacing));
    if (axis.scale == Scale::Linear) {
        const double step = niceStep((layout.high - layout.low) / maxTicks);
        // Ends that nobody asked for become ticks where that wastes little.
        if (padded && !axis.low && data.low >= 0 && layout.low < 2 * step) layout.low = 0;
        addLinearTicks(layout, step);
        return layout;
    }
    constexpr double kFewDecades = 2.0;
    if (std::log10(layout.high) - std::log10(layout.low) >= kFewDecades) {
        addDecades(layout, maxTicks);
        return layout;
    }
    addShortLogarithmicTicks(layout);
    if (layout.ticks.size() < 2) {
        layout.ticks.clear();
        layout.minorTicks.clear();
        addLinearTicks(layout, niceStep((layout.high - layout.low) / maxTicks));
    }
    return layout;
}

std::vector<AxisTick> ticksAt(const std::vector<double>& values) {
    std::vector<AxisTick> ticks;
    for (const double value : values) ticks.push_back({value, numberText(value)});
    return ticks;
}

std::vector<double> cellEdges(const std::vector<double>& centres, Scale scale) {
    const bool logarithmic = scale == Scale::Logarithmic;
    if (centres.empty()) return {};
    if (centres.size() == 1) {
        return logarithmic ? std::vector{centres[0] / 2, centres[0] * 2}
                           : std::vector{centres[0] - 0.5, centres[0] + 0.5};
    }
    std::vector<double> places(centres);
    if (logarithmic) {
        for (double& place : places) place = std::log(place);
    }
    std::vector<double> edges{places[0] - (places[1] - places[0]) / 2};
    for (std::size_t i = 1; i < places.size(); ++i) edges.push_back((places[i - 1] + places[i]) / 2);
    edges.push_back(places.back() + (places.back() - places[places.size() - 2]) / 2);
    if (logarithmic) {
        for (double& edge : edges) edge = std::exp(edge);
    }
    return edges;
}

}  // namespace hairloom
